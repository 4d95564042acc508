// Primitives as repetitions between ridges of the path cost.
#pragma once

#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/primitive.h"

namespace kinetome {

/// Where the primitives of an activity begin, and where the last of them ends: ascending from the
/// activity's first frame to its end, or to the start of what the end of the take cuts off.
std::vector<int64_t> cost_ridge_cuts(const MatrixFView& features, const RowRange& activity,
                                     const PrimitiveOptions& options);

}  // namespace kinetome
