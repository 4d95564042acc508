// Slow wandering: random functions of time that are smooth and remember nothing for long.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kinetome/base/random.h"

namespace kinetome {

/// A uniform cubic B-spline over independent normal coefficients, walked forward in time.
class Drift {
  public:
    /// `spread`: standard deviation of the values; `knot_seconds`: between coefficients, so about
    /// how long the drift stays on one side. Starts at a random place between two coefficients.
    Drift(double spread, double knot_seconds, RandomStream& random);

    /// The value `seconds` after the last one.
    double next(double seconds, RandomStream& random);

  private:
    double scale_;
    double knots_a_second_;
    double at_;  ///< between the second and the third coefficient, in [0, 1)
    std::array<double, 4> coefficients_;
};

/// A standard normal number, near enough for noise (the sum of four uniform numbers of 16 bits), at
/// a tenth of the cost.
double quick_normal(RandomStream& random);

}  // namespace kinetome
