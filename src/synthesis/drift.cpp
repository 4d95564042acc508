#include "kinetome/synthesis/drift.h"

#include <cmath>

namespace kinetome {
namespace {

/// Variance of a cubic B-spline with unit coefficients, averaged over its phase: Σ ∫ bᵢ(u)² du.
constexpr double spline_variance = 151.0 / 315.0;

}  // namespace

Drift::Drift(double spread, double knot_seconds, RandomStream& random)
    : scale_(spread / std::sqrt(spline_variance)),
      knots_a_second_(1 / knot_seconds),
      at_(random.uniform()) {
    for (double& coefficient : coefficients_) coefficient = quick_normal(random);
}

double Drift::next(double seconds, RandomStream& random) {
    at_ += seconds * knots_a_second_;
    while (at_ >= 1) {
        at_ -= 1;
        for (size_t i = 0; i < 3; ++i) coefficients_[i] = coefficients_[i + 1];
        coefficients_[3] = quick_normal(random);
    }
    const double u = at_, v = 1 - at_;
    const double b0 = v * v * v, b3 = u * u * u;
    const double b1 = 4 - 3 * u * u * (2 - u), b2 = 4 - 3 * v * v * (2 - v);
    return scale_ / 6 *
           (b0 * coefficients_[0] + b1 * coefficients_[1] + b2 * coefficients_[2] +
            b3 * coefficients_[3]);
}

double quick_normal(RandomStream& random) {
    uint64_t bits = random();
    double sum = -2.0 * 65535;
    for (int part = 0; part < 4; ++part, bits >>= 16) sum += static_cast<double>(bits & 0xffff);
    constexpr double spread = 65536 * 0.57735026918962576;  // √(4/12) of the 16-bit range
    return sum / spread;
}

}  // namespace kinetome
