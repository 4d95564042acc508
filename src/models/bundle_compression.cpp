#include "kinetome/models/bundle_compression.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "kinetome/math/warp.h"

namespace kinetome {

size_t representative_of(std::span<const double> lengths) {
    if (lengths.empty()) throw std::invalid_argument("a bundle has members");
    const double mean =
        std::accumulate(lengths.begin(), lengths.end(), 0.0) / static_cast<double>(lengths.size());
    const auto nearest = std::ranges::min_element(
        lengths, {}, [&](double length) { return std::abs(length - mean); });
    return static_cast<size_t>(nearest - lengths.begin());
}

double squared_stand_in_error(const MatrixFView& member, const MatrixFView& representative) {
    if (member.rows() == 0 || representative.rows() == 0)
        throw std::invalid_argument("members have poses");
    // Whatever their lengths are, there is a path.
    const WarpPath path = warp(member, representative, {.steps = {{1, 1}, {0, 1}, {1, 0}}});
    std::vector<double> least(static_cast<size_t>(member.rows()),
                              std::numeric_limits<double>::infinity());
    for (const WarpCell& cell : path.cells) {
        const auto difference = member.row(cell.first) - representative.row(cell.second);
        double& squared = least[static_cast<size_t>(cell.first)];
        squared = std::min(squared, difference.cast<double>().squaredNorm());
    }
    return std::accumulate(least.begin(), least.end(), 0.0);
}

}  // namespace kinetome
