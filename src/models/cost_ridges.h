// Primitives as repetitions between ridges of the path cost.
#pragma once

#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/primitive.h"

namespace kinetome {

/// First frames of the primitives of an activity, ascending from its own first frame.
std::vector<int64_t> cost_ridge_starts(const MatrixFView& features, const RowRange& activity,
                                       const PrimitiveOptions& options);

}  // namespace kinetome
