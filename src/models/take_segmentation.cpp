#include "kinetome/models/take_segmentation.h"

#include <map>

#include "disjoint_sets.h"

namespace kinetome {

SegmentationOptions adapted(SegmentationOptions options, double rate, double radius_ratio) {
    options.activities.rate = options.primitives.rate = rate;
    RepetitionOptions& repetition = options.activities.repetition;
    CostRidgeOptions& ridges = options.primitives.cost_ridges;
    for (double* distance : {&repetition.radius, &repetition.transition_floor,
                             &options.activities.region_growing.radius, &ridges.radius,
                             &ridges.least_ridge, &options.primitives.warping_paths.radius,
                             &options.clusters.threshold, &options.clusters.radius}) {
        *distance *= radius_ratio;
    }
    return options;
}

std::vector<int32_t> cluster_take(const MatrixFView& features,
                                  std::span<const Primitive> primitives,
                                  const PrimitiveClusterOptions& options) {
    std::vector<CorpusPrimitive> in_one_clip;
    for (const Primitive& primitive : primitives) in_one_clip.push_back({0, primitive.frames});
    return cluster_primitives(features, in_one_clip, options, 1);
}

void join_activities(std::vector<Segment>& segments, std::span<const Primitive> primitives,
                     std::span<const int32_t> primitive_clusters) {
    DisjointSets activities(static_cast<int64_t>(segments.size()));
    std::map<int32_t, int32_t> activity_with;  // each cluster of primitives → one activity
    for (size_t p = 0; p < primitives.size(); ++p) {
        const int32_t activity = primitives[p].activity;
        const auto [known, is_new] = activity_with.emplace(primitive_clusters[p], activity);
        if (!is_new) activities.unite(known->second, activity);
    }
    std::map<int32_t, int32_t> numbers;
    for (size_t s = 0; s < segments.size(); ++s) {
        if (segments[s].kind == SegmentKind::transition) continue;
        const auto next = static_cast<int32_t>(numbers.size());
        segments[s].cluster =
            numbers.emplace(activities.root(static_cast<int32_t>(s)), next).first->second;
    }
}

std::vector<Segment> segment_take(const NeighborGraph& graph, const MatrixFView& features,
                                  const SegmentationOptions& options) {
    std::vector<Segment> segments = find_activities(graph, features, options.activities);
    if (options.activities.method == ActivityMethod::region_growing) {
        const auto primitives = find_primitives(features, graph, segments, options.primitives);
        join_activities(segments, primitives, cluster_take(features, primitives, options.clusters));
    }
    return segments;
}

}  // namespace kinetome
