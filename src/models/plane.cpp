#include "plane.h"

#include <array>
#include <cstddef>

namespace kinetome {

double along_normal(const double* normal, const double* values, int64_t dimension) {
    // As many sums as keep the adders busy, in a fixed order.
    constexpr int64_t width = 8;
    std::array<double, width> sums{};
    int64_t i = 0;
    for (; i + width <= dimension; i += width) {
        for (int64_t lane = 0; lane < width; ++lane) {
            sums[static_cast<size_t>(lane)] += normal[i + lane] * values[i + lane];
        }
    }
    double sum =
        ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
    for (; i < dimension; ++i) sum += normal[i] * values[i];
    return sum;
}

}  // namespace kinetome
