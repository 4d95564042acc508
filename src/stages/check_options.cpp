#include <fmt/format.h>

#include <limits>
#include <regex>

#include "kinetome/base/error.h"
#include "kinetome/base/pieces.h"
#include "kinetome/stages/options.h"
#include "kinetome/store/artifact.h"

namespace kinetome {
namespace {

void require(bool holds, const std::string& what) {
    if (!holds) throw UsageError(what);
}

}  // namespace

void check_options(const ReindexOptions& o) {
    const PoseClusterOptions& p = o.pose_clusters;
    const MixtureOptions& m = p.mixture;
    require(o.frames.amc.rate > 0, "amc-rate must be above 0");
    require(o.frames.joint_map.empty() || std::filesystem::is_regular_file(o.frames.joint_map),
            fmt::format("joint-map {}: no such file", o.frames.joint_map));
    require(o.frames.shard_frames >= group_frames,
            fmt::format("shard-frames must be at least {}", group_frames));
    parse_compression(o.frames.compression);
    require(o.features.pose_rate > 0 && o.features.effector_rate > 0,
            "pose-rate and effector-rate must be above 0");
    require(o.features.velocity_reach > 0, "velocity-reach must be above 0");
    require(p.variance_share > 0 && p.variance_share <= 1, "variance-share must be in (0, 1]");
    require(p.clusters >= 0, "clusters must not be negative");
    require(p.count_rule != ClusterCountRule::bic || !p.bic_clusters.empty(),
            "cluster-rule bic needs bic-clusters, for example 100,200,400");
    for (const int64_t clusters : p.bic_clusters) {
        require(clusters > 0, "bic-clusters must be above 0");
    }
    require(p.frames_per_cluster > 0, "frames-per-cluster must be above 0");
    require(p.least_clusters > 0 && p.least_clusters <= p.most_clusters,
            "least-clusters must be above 0 and not above most-clusters");
    require(m.max_iterations > 0 && m.restarts > 0 && m.start_sample > 0,
            "max-iterations, restarts and start-sample must be above 0");
    require(m.min_gain >= 0, "min-gain must not be negative");
    require(m.seed <= std::numeric_limits<int64_t>::max(),
            fmt::format("seed must be at most {}", std::numeric_limits<int64_t>::max()));
    require(m.variance_floor > 0, "variance-floor must be above 0");
    require(o.motion_strings.longest_submotion > 0, "longest-submotion must be above 0");
    require(o.motion_strings.tau >= 0, "tau must not be negative");
    require(o.motion_strings.tau_quantile > 0 && o.motion_strings.tau_quantile <= 1,
            "tau-quantile must be in (0, 1]");
    require(o.principal_markers.tolerance > 0 && o.principal_markers.starts > 0,
            "principal-tolerance and principal-starts must be above 0");
    require(o.pose_hierarchy.dimension > 0 && o.pose_hierarchy.leaf_tolerance > 0,
            "leaf-dimension and leaf-tolerance must be above 0");
    require(o.pose_hierarchy.overlap >= 0 && o.pose_hierarchy.maps.parent_weight >= 0,
            "leaf-overlap and parent-weight must not be negative");
    constexpr double largest_rho = 16;  // beyond, the volume of a wide bundle is soon no number
    require(o.bundles.rho > 0 && o.bundles.rho <= largest_rho,
            fmt::format("rho must be above 0 and at most {}", largest_rho));
    require(o.bundles.gamma >= 0 && o.bundles.gamma <= 1, "gamma must be in [0, 1]");
    require(o.bundles.step_quantile > 0 && o.bundles.step_quantile <= 1,
            "step-quantile must be in (0, 1]");
    require(o.bundle_ends.sweeps >= 0, "bundle-sweeps must not be negative");
    require(o.bundles.seed <= std::numeric_limits<int64_t>::max(),
            fmt::format("bundle-seed must be at most {}", std::numeric_limits<int64_t>::max()));
    require(o.neighbors.knn.radius > 0, "radius must be above 0");
    require(o.neighbors.knn.neighbours > 0, "neighbours must be above 0");
    require(o.neighbors.stack_offset >= 0, "stack-offset must not be negative");
    require(o.neighbors.adapt_radius >= 0, "adapt-radius must not be negative");
    require(o.corpus_neighbors.exclusion >= 0, "corpus-exclusion must not be negative");
    require(!o.corpus_neighbors.wanted || o.neighbors.engine == KnnEngine::blocks,
            "corpus-graph needs knn-engine blocks: what flann finds depends on how takes are "
            "divided among files");
    require(o.activities.repetition.segment_cost >= 0 &&
                o.activities.repetition.least_repetition >= 0 &&
                o.activities.repetition.least_sameness >= 0,
            "segment-cost, least-repetition and least-sameness must not be negative");
    require(o.activities.longest_transition >= 0 && o.activities.region_growing.patience > 0,
            "longest-transition must not be negative, patience must be above 0");
    require(o.primitives.shortest > 0, "shortest-primitive must be above 0");
    require(o.primitive_clusters.threshold >= 0, "primitive-threshold must not be negative");
    require(o.primitive_clusters.share_across >= 0 && o.primitive_clusters.share_across <= 1,
            "share-across must be in [0, 1]");
    try {
        const std::regex expression(o.partition.subject_from);
        require(o.partition.subject_from.empty() || expression.mark_count() >= 1,
                "subject-from needs a group, such as 'subject_(\\d+)'");
    } catch (const std::regex_error& error) {
        throw UsageError(fmt::format("subject-from: {}", error.what()));
    }
}

}  // namespace kinetome
