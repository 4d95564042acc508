// A take cut into activities and primitives: the steps of S3 §3–4 in their order.
#pragma once

#include <span>
#include <vector>

#include "kinetome/models/activity.h"
#include "kinetome/models/primitive.h"
#include "kinetome/models/primitive_clusters.h"

namespace kinetome {

/// How a take is cut.
struct SegmentationOptions {
    ActivityOptions activities;
    PrimitiveOptions primitives;
    PrimitiveClusterOptions clusters;
};

/// The same for a take whose graph was searched within another radius than the options mean: all
/// distances in proportion. `rate`: frames a second of the features.
SegmentationOptions adapted(SegmentationOptions options, double rate, double radius_ratio);

/// The take's primitives by cluster, numbered as they appear.
std::vector<int32_t> cluster_take(const MatrixFView& features,
                                  std::span<const Primitive> primitives,
                                  const PrimitiveClusterOptions& options);

/// Activities that share a cluster of primitives are the same one (S3 §4): clusters of activities
/// are numbered anew as they appear.
void join_activities(std::vector<Segment>& segments, std::span<const Primitive> primitives,
                     std::span<const int32_t> primitive_clusters);

/// find_activities; with region_growing, which cannot tell what is the same, clusters of primitives
/// tell.
std::vector<Segment> segment_take(const NeighborGraph& graph, const MatrixFView& features,
                                  const SegmentationOptions& options);

}  // namespace kinetome
