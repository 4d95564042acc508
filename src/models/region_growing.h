// Activities as S3 §3.1 finds them.
#pragma once

#include <vector>

#include "kinetome/models/activity.h"

namespace kinetome {

/// Segments of a take, each activity a cluster of its own; the graph is taken as it is, whatever
/// its radius. `longest_transition` in frames.
std::vector<Segment> grown_regions(const NeighborGraph& graph, const RegionGrowingOptions& options,
                                   double rate, int64_t longest_transition);

}  // namespace kinetome
