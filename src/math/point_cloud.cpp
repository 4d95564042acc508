#include "kinetome/math/point_cloud.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kinetome {
namespace {

/// Clouds (n × 3p) with the middle of each above the origin.
MatrixD centred_on_floor(const MatrixFView& clouds) {
    MatrixD centred = clouds.cast<double>();
    const int64_t points = clouds.cols() / 3;
    for (int64_t i = 0; i < centred.rows(); ++i) {
        for (const int64_t axis : {0, 2}) {
            double sum = 0;
            for (int64_t p = 0; p < points; ++p) sum += centred(i, 3 * p + axis);
            const double middle = sum / double(points);
            for (int64_t p = 0; p < points; ++p) centred(i, 3 * p + axis) -= middle;
        }
    }
    return centred;
}

/// Of two centred clouds, after the best turn: turned by θ, what is won is
/// 2 (along · cos θ + across · sin θ), so at best 2 · |(along, across)|.
double squared_distance(const double* a, const double* b, int64_t points) {
    double squares = 0, along = 0, across = 0;
    for (int64_t p = 0; p < points; ++p, a += 3, b += 3) {
        squares += (a[1] - b[1]) * (a[1] - b[1]);
        squares += a[0] * a[0] + a[2] * a[2] + b[0] * b[0] + b[2] * b[2];
        along += a[0] * b[0] + a[2] * b[2];
        across += a[0] * b[2] - a[2] * b[0];
    }
    // Rounding may leave a zero slightly negative.
    return std::max(0.0, squares - 2 * std::hypot(along, across));
}

}  // namespace

MatrixD point_cloud_distances(const MatrixFView& first, const MatrixFView& second) {
    if (first.cols() != second.cols() || first.cols() == 0 || first.cols() % 3 != 0) {
        throw std::invalid_argument(
            "point clouds need three columns a point and equally many points");
    }
    const MatrixD a = centred_on_floor(first), b = centred_on_floor(second);
    const int64_t points = first.cols() / 3;
    MatrixD distances(a.rows(), b.rows());
    for (int64_t i = 0; i < a.rows(); ++i) {
        for (int64_t j = 0; j < b.rows(); ++j) {
            const double squares = squared_distance(a.row(i).data(), b.row(j).data(), points);
            distances(i, j) = std::sqrt(squares / double(points));
        }
    }
    return distances;
}

}  // namespace kinetome
