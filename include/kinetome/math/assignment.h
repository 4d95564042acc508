// The assignment problem: who gets what so that the whole is worth most (Kuhn 1955, Munkres 1957).
#pragma once

#include <cstdint>
#include <vector>

#include "kinetome/base/matrix.h"

namespace kinetome {

/// For each row of the n × m `values` its column, no column twice, such that the values chosen sum
/// to the most: min(n, m) rows have one, the others -1. The same columns for the same values; which
/// of several best assignments that is, is not said. O(min² · max). Throws std::invalid_argument
/// for a value that is not finite.
std::vector<int32_t> best_assignment(const MatrixDView& values);

}  // namespace kinetome
