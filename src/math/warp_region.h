// Which cells of a warping table lie on a path from one end to the other, whatever the distances.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/pieces.h"
#include "kinetome/math/warp.h"

namespace kinetome {

/// For each of n rows the columns, out of m, between which such cells lie; empty where none do.
std::vector<RowRange> warp_region(int64_t n, int64_t m, std::span<const WarpStep> steps,
                                  int64_t end_slip);

}  // namespace kinetome
