// Primitives as S3 §3.2 finds them.
#pragma once

#include <vector>

#include "kinetome/models/neighbor_graph.h"
#include "kinetome/models/primitive.h"

namespace kinetome {

/// Where the primitives of an activity begin and end: ascending from its first frame to its end.
std::vector<int64_t> minor_diagonal_cuts(const NeighborGraph& graph, const RowRange& activity,
                                         const PrimitiveOptions& options);

}  // namespace kinetome
