// What engines of the neighbour search are compared by.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace kinetome::bench {

/// Squared distance and row of each query's neighbours, the nearest first.
using Lists = std::vector<std::vector<std::pair<float, size_t>>>;

}  // namespace kinetome::bench
