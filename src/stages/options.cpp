#include "kinetome/stages/options.h"

#include <array>
#include <utility>

#include "option_row.h"

namespace kinetome {
namespace {

constexpr std::array partition_names = {std::pair{"none", PartitionRule::none},
                                        std::pair{"subject", PartitionRule::subject},
                                        std::pair{"auto", PartitionRule::automatic}};
constexpr std::array count_rule_names = {std::pair{"ratio", ClusterCountRule::ratio},
                                         std::pair{"bic", ClusterCountRule::bic}};

constexpr std::array member_length_names = {std::pair{"seed", MemberLength::seed},
                                            std::pair{"mean", MemberLength::mean}};
constexpr std::array leaf_rule_names = {std::pair{"rms", LeafRule::rms},
                                        std::pair{"max", LeafRule::maximum}};
constexpr std::array map_rule_names = {std::pair{"shrinkage", MarkerMapRule::shrinkage},
                                       std::pair{"least-squares", MarkerMapRule::least_squares}};

constexpr std::array off_and_on = {std::pair{"off", false}, std::pair{"on", true}};
constexpr std::array knn_engine_names = {std::pair{"blocks", KnnEngine::blocks},
                                         std::pair{"flann", KnnEngine::flann}};

constexpr std::array activity_method_names = {
    std::pair{"repetition", ActivityMethod::repetition},
    std::pair{"region-growing", ActivityMethod::region_growing}};
constexpr std::array primitive_method_names = {
    std::pair{"cost-ridges", PrimitiveMethod::cost_ridges},
    std::pair{"warping-paths", PrimitiveMethod::warping_paths}};

}  // namespace

std::vector<OptionRow> option_rows(ReindexOptions& o) {
    PoseClusterOptions& p = o.pose_clusters;
    MixtureOptions& m = p.mixture;
    PoseHierarchyOptions& h = o.pose_hierarchy;
    NeighborOptions& g = o.neighbors;
    ActivityOptions& a = o.activities;
    PrimitiveOptions& s = o.primitives;
    return {
        number("amc-rate", "frames", o.frames.amc.rate,
               "frames a second of AMC takes, which do not state it"),
        text_option("joint-map", "", o.frames.joint_map,
                    "TOML file: which joint has which role, for rigs with unknown names"),
        number("shard-frames", "files", o.frames.shard_frames, "mean frames of a shard file"),
        text_option("compression", "files", o.frames.compression, "of artifacts (none|gzip|blosc)"),
        number("pose-rate", "features", o.features.pose_rate,
               "frames a second of pose vectors and markers"),
        number("effector-rate", "features", o.features.effector_rate,
               "frames a second of effector features"),
        number("velocity-reach", "features", o.features.velocity_reach,
               "seconds to either side of a velocity's difference"),
        choice("partition", "pose_clusters", o.partition.rule, partition_names,
               "which clips share pose clusters; auto: by subject above 50,000 frames"),
        text_option("subject-from", "pose_clusters", o.partition.subject_from,
                    "regular expression on a take's path whose first group is its subject; "
                    "empty: the parent folder"),
        number("variance-share", "pose_clusters", p.variance_share,
               "share of the variance that the principal components keep"),
        choice("cluster-rule", "pose_clusters", p.count_rule, count_rule_names,
               "how the number of clusters is chosen when it is not given"),
        number("clusters", "pose_clusters", p.clusters, "number of clusters; 0: by cluster-rule"),
        number("frames-per-cluster", "pose_clusters", p.frames_per_cluster,
               "clusters = frames / this, when cluster-rule is ratio"),
        number("least-clusters", "pose_clusters", p.least_clusters, "at least so many clusters"),
        number("most-clusters", "pose_clusters", p.most_clusters, "at most so many clusters"),
        count_list("bic-clusters", "pose_clusters", p.bic_clusters,
                   "numbers of clusters to try, separated by commas, when cluster-rule is bic"),
        number("max-iterations", "pose_clusters", m.max_iterations, "EM iterations at most"),
        number("min-gain", "pose_clusters", m.min_gain,
               "EM stops when the mean log-likelihood gains less (nats)"),
        number("variance-floor", "pose_clusters", m.variance_floor,
               "least variance of a cluster, as a share of the data's per-dimension variance"),
        number("seed", "pose_clusters", m.seed, "seed of the k-means++ start"),
        number("restarts", "pose_clusters", m.restarts,
               "starts of EM; the one of highest likelihood is kept"),
        number("start-sample", "pose_clusters", m.start_sample,
               "frames that the start is drawn from, at most"),
        number("longest-submotion", "motion_strings", o.motion_strings.longest_submotion,
               "longest submotion λ′, seconds"),
        number("tau", "motion_strings", o.motion_strings.tau,
               "distance below which letters are equal; 0: by tau-quantile"),
        number("tau-quantile", "motion_strings", o.motion_strings.tau_quantile,
               "tau is the distance that this share of adjacent letters is within"),
        number("principal-tolerance", "pose_hierarchy", o.principal_markers.tolerance,
               "mm per marker that the components which principal markers stand for may leave "
               "unexplained"),
        number("principal-starts", "pose_hierarchy", o.principal_markers.starts,
               "sets of principal markers that the best is chosen from"),
        number("leaf-dimension", "pose_hierarchy", h.dimension,
               "of the linear model in each leaf of the pose hierarchy"),
        number("leaf-tolerance", "pose_hierarchy", h.leaf_tolerance,
               "mm per marker that a leaf's linear model may leave unexplained"),
        choice("leaf-rule", "pose_hierarchy", h.leaf_rule, leaf_rule_names,
               "what of a leaf is within the tolerance: the RMS over its poses, or every pose"),
        number("leaf-overlap", "pose_hierarchy", h.overlap,
               "poses within so many half gaps of a plane belong to both sides; 0: to one"),
        choice("marker-maps", "pose_hierarchy", h.maps.rule, map_rule_names,
               "how a leaf's map to the other markers is found"),
        number("parent-weight", "pose_hierarchy", h.maps.parent_weight,
               "poses that the map of a node's parent counts as; marker-maps shrinkage"),
        number("rho", "bundles", o.bundles.rho,
               "above 1 prefers longer motion bundles, below 1 those with more members"),
        number("gamma", "bundles", o.bundles.gamma,
               "least ratio between the length of a member and its bundle's mean; 0: any"),
        spread_option("spread", "bundles", o.bundles),
        number("step-quantile", "bundles", o.bundles.step_quantile,
               "letters that differ by more than this share of adjacent ones are not matched; "
               "1: tau alone tells"),
        choice("member-length", "bundles", o.bundles.member_length, member_length_names,
               "of similar motions that overlap those are members whose lengths are nearest to the "
               "seed's, or to the mean of all"),
        number("bundle-seed", "bundles", o.bundles.seed,
               "of the instances at which bundles are sought"),
        number("bundle-sweeps", "bundles", o.bundle_ends.sweeps,
               "times that the frames at which members begin and end are gone through, at most"),
        number("radius", "neighbors", g.knn.radius, "frames no farther apart are neighbours, cm"),
        number("neighbours", "neighbors", g.knn.neighbours,
               "at most so many of each frame, itself among them, the nearest"),
        number("stack-offset", "neighbors", g.stack_offset,
               "seconds between a frame and those before and after that it is compared with"),
        joint_list("joints", "neighbors", g.joints,
                   "whose motion is compared, separated by commas; the radius is scaled to their "
                   "number"),
        number("adapt-radius", "neighbors", g.adapt_radius,
               "radius of a take at most this multiple of the median distance between its frames, "
               "for motion of low amplitude; 0: the same radius for all takes"),
        choice("knn-engine", "neighbors", g.engine, knn_engine_names,
               "that searches neighbours; flann rounds"),
        choice("corpus-graph", "corpus_neighbors", o.corpus_neighbors.wanted, off_and_on,
               "whether neighbours are searched in all takes, too"),
        number("corpus-exclusion", "corpus_neighbors", o.corpus_neighbors.exclusion,
               "seconds: in the graph of all takes, frames of the same take that are nearer in "
               "time are left out; 0: none"),
        choice("method", "segments", a.method, activity_method_names,
               "how takes are cut into activities"),
        number("segment-cost", "segments", a.repetition.segment_cost,
               "repetitions that one activity more must bring; method repetition"),
        number("least-repetition", "segments", a.repetition.least_repetition,
               "repetitions of an activity that is no longer than a transition; method repetition"),
        number("least-sameness", "segments", a.repetition.least_sameness,
               "from which two activities of a take are the same; method repetition"),
        number("longest-transition", "segments", a.longest_transition,
               "seconds; what does not repeat for longer is an activity"),
        number("patience", "segments", a.region_growing.patience,
               "seconds without new neighbours that end an activity; method region-growing"),
        choice("primitive-method", "segments", s.method, primitive_method_names,
               "how primitives are found in an activity"),
        number("shortest-primitive", "segments", s.shortest, "seconds of a primitive, at least"),
        number("primitive-threshold", "segments", o.primitive_clusters.threshold,
               "mean distance along the path that warps one primitive to another of its cluster, "
               "cm, at most"),
        choice("join-alternations", "primitives", o.alternations.joined, off_and_on,
               "whether two primitives of a take that always follow each other, as a step of one "
               "foot a step of the other, become one"),
        number("share-across", "segments", o.primitive_clusters.share_across,
               "of the pairs between clusters of different takes: so many must be alike for the "
               "clusters to be one"),
    };
}

ReindexOptions paper_options() {
    ReindexOptions options;
    options.partition.rule = PartitionRule::none;          // S1 clusters each database as a whole
    options.motion_strings.tau_quantile = 0.5;             // S1 §3.6
    options.bundles.step_quantile = 1;                     // S1 Eq. 2
    options.bundles.spread = BundleSpread::closure;        // S1 Eq. 5
    options.bundles.member_length = MemberLength::mean;    // S1 §3.4, Figure 4
    options.pose_hierarchy.leaf_rule = LeafRule::maximum;  // S2 §6, of any pose
    options.pose_hierarchy.overlap = 0.1;                  // S2 §4, fuzzy partition
    options.pose_hierarchy.maps.rule = MarkerMapRule::least_squares;  // S2 Eq. 1
    options.neighbors.knn.radius = 64;                                // S3 §5
    options.activities.method = ActivityMethod::region_growing;       // S3 §3.1
    options.primitives.method = PrimitiveMethod::warping_paths;       // S3 §3.2
    return options;
}

}  // namespace kinetome
