// Primitives as S3 §3.2 finds them.
#pragma once

#include <vector>

#include "kinetome/models/neighbor_graph.h"
#include "kinetome/models/primitive.h"

namespace kinetome {

/// First frames of the primitives of an activity, ascending from its own first frame.
std::vector<int64_t> minor_diagonal_starts(const NeighborGraph& graph, const RowRange& activity,
                                           const PrimitiveOptions& options);

}  // namespace kinetome
