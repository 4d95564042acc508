#include "kinetome/stages/options.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <limits>
#include <regex>
#include <sstream>
#include <utility>

#include "joint_words.h"
#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/pieces.h"
#include "kinetome/store/artifact.h"

namespace kinetome {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& text,
                         const std::string& want) {
    throw UsageError(fmt::format("{} = '{}': expected {}", name, text, want));
}

/// Text of a value and back; one overload a type that an option may have.
template <class T>
requires(std::integral<T> || std::floating_point<T>) struct ValueText {
    static std::string get(T value) { return fmt::format("{}", value); }
    static void set(const std::string& name, const std::string& text, T& value) {
        T parsed{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
        if (error != std::errc() || end != text.data() + text.size()) {
            refuse(name, text, std::integral<T> ? "a whole number" : "a number");
        }
        if constexpr (std::floating_point<T>) {
            if (!std::isfinite(parsed)) refuse(name, text, "a finite number");
        }
        value = parsed;
    }
};

template <class T>
OptionRow number(std::string name, std::string stage, T& value, std::string help) {
    return {name,
            std::move(stage),
            OptionKind::number,
            std::move(help),
            [&value] { return ValueText<T>::get(value); },
            [&value, name](const std::string& text) { ValueText<T>::set(name, text, value); }};
}

OptionRow text_option(std::string name, std::string stage, std::string& value, std::string help) {
    return {std::move(name),
            std::move(stage),
            OptionKind::text,
            std::move(help),
            [&value] { return value; },
            [&value](const std::string& text) { value = text; }};
}

template <class E, size_t n>
OptionRow choice(std::string name, std::string stage, E& value,
                 const std::array<std::pair<const char*, E>, n>& names, std::string help) {
    std::vector<std::string> all;
    for (const auto& [text, one] : names) all.emplace_back(text);
    help += fmt::format(" ({})", fmt::join(all, "|"));
    return {name,
            std::move(stage),
            OptionKind::text,
            std::move(help),
            [&value, names] {
                for (const auto& [text, one] : names) {
                    if (one == value) return std::string(text);
                }
                return std::string();
            },
            [&value, names, name, all](const std::string& text) {
                for (const auto& [known, one] : names) {
                    if (text == known) {
                        value = one;
                        return;
                    }
                }
                refuse(name, text, fmt::format("one of {}", fmt::join(all, ", ")));
            }};
}

OptionRow count_list(std::string name, std::string stage, std::vector<int64_t>& values,
                     std::string help) {
    return {name,
            std::move(stage),
            OptionKind::text,
            std::move(help),
            [&values] { return fmt::format("{}", fmt::join(values, ",")); },
            [&values, name](const std::string& text) {
                std::vector<int64_t> parsed;
                std::istringstream parts(text);
                for (std::string part; std::getline(parts, part, ',');) {
                    ValueText<int64_t>::set(name, part, parsed.emplace_back());
                }
                values = std::move(parsed);
            }};
}

OptionRow joint_list(std::string name, std::string stage, std::vector<JointRole>& joints,
                     std::string help) {
    help += fmt::format(" ({})", fmt::join(joint_words(), "|"));
    return {name,
            std::move(stage),
            OptionKind::text,
            std::move(help),
            [&joints] { return write_joints(joints); },
            [&joints, name](const std::string& text) {
                const auto parsed = parse_joints(text);
                if (!parsed) {
                    refuse(name, text, fmt::format("some of {}", fmt::join(joint_words(), ", ")));
                }
                joints = *parsed;
            }};
}

OptionRow spread_option(std::string name, std::string stage, MotionBundleOptions& bundles) {
    return {name,
            std::move(stage),
            OptionKind::text,
            "how far the similarity of substrings is spread from one to others (closure|"
            "closure-near|closure-length|depth:N)",
            [&bundles] { return spread_text(bundles); },
            [&bundles, name](const std::string& text) {
                try {
                    parse_spread(text, bundles);
                } catch (const std::invalid_argument&) {
                    refuse(name, text, "closure, closure-near, closure-length or depth:N");
                }
            }};
}

constexpr std::array partition_names = {std::pair{"none", PartitionRule::none},
                                        std::pair{"subject", PartitionRule::subject},
                                        std::pair{"auto", PartitionRule::automatic}};
constexpr std::array count_rule_names = {std::pair{"ratio", ClusterCountRule::ratio},
                                         std::pair{"bic", ClusterCountRule::bic}};

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

/// One value as the option's text, from whatever TOML type it has.
std::string toml_text(const std::string& origin, const std::string& name, const toml::node& node) {
    if (const auto value = node.value_exact<std::string>()) return *value;
    if (const auto value = node.value_exact<int64_t>()) return fmt::format("{}", *value);
    if (const auto value = node.value_exact<double>()) return fmt::format("{}", *value);
    if (const toml::array* array = node.as_array()) {
        std::vector<std::string> parts;
        for (const toml::node& part : *array) parts.push_back(toml_text(origin, name, part));
        return fmt::format("{}", fmt::join(parts, ","));
    }
    throw UsageError(fmt::format("{}:{}: {} must be a number or a text", origin,
                                 node.source().begin.line, name));
}

std::string quoted(const std::string& text) {
    std::ostringstream out;
    out << toml::value<std::string>(text);
    return out.str();
}

void require(bool holds, const std::string& what) {
    if (!holds) throw UsageError(what);
}

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
               "distance below which letters are equal; 0: the median adjacent distance"),
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
    options.partition.rule = PartitionRule::none;    // S1 clusters each database as a whole
    options.bundles.spread = BundleSpread::closure;  // S1 Eq. 5
    options.pose_hierarchy.overlap = 0.1;            // S2 §4, fuzzy partition
    options.pose_hierarchy.maps.rule = MarkerMapRule::least_squares;  // S2 Eq. 1
    options.neighbors.knn.radius = 64;                                // S3 §5
    options.activities.method = ActivityMethod::region_growing;       // S3 §3.1
    options.primitives.method = PrimitiveMethod::warping_paths;       // S3 §3.2
    return options;
}

std::set<std::string> parse_configuration(std::string_view text, const std::string& origin,
                                          ReindexOptions& options) {
    toml::table table;
    try {
        table = toml::parse(text, origin);
    } catch (const toml::parse_error& error) {
        throw UsageError(
            fmt::format("{}:{}: {}", origin, error.source().begin.line, error.description()));
    }
    auto rows = option_rows(options);
    std::set<std::string> names;
    for (const auto& [key, node] : table) {
        const std::string name(key.str());
        const auto row = std::find_if(rows.begin(), rows.end(),
                                      [&](const OptionRow& r) { return r.name == name; });
        if (row == rows.end()) {
            throw UsageError(fmt::format("{}:{}: no option is called '{}'", origin,
                                         node.source().begin.line, name));
        }
        try {
            row->set(toml_text(origin, name, node));
        } catch (const UsageError& error) {
            throw UsageError(
                fmt::format("{}:{}: {}", origin, node.source().begin.line, error.what()));
        }
        names.insert(name);
    }
    return names;
}

std::set<std::string> read_configuration(const std::filesystem::path& file,
                                         ReindexOptions& options) {
    if (!std::filesystem::is_regular_file(file)) {
        throw UsageError(file.string() + ": no such configuration file");
    }
    return parse_configuration(read_file(file), file.string(), options);
}

std::string write_configuration(const ReindexOptions& options) {
    ReindexOptions copy = options;
    std::string text =
        "# Options in force, defaults written out. `kinetome reindex --config` reads it.\n";
    for (const OptionRow& row : option_rows(copy)) {
        const std::string value = row.get();
        text += fmt::format("\n# {}\n{} = {}\n", row.help, row.name,
                            row.kind == OptionKind::text ? quoted(value) : value);
    }
    return text;
}

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
    require(o.principal_markers.tolerance > 0 && o.principal_markers.starts > 0,
            "principal-tolerance and principal-starts must be above 0");
    require(o.pose_hierarchy.dimension > 0 && o.pose_hierarchy.leaf_tolerance > 0,
            "leaf-dimension and leaf-tolerance must be above 0");
    require(o.pose_hierarchy.overlap >= 0 && o.pose_hierarchy.maps.parent_weight >= 0,
            "leaf-overlap and parent-weight must not be negative");
    require(o.bundles.rho > 0, "rho must be above 0");
    require(o.bundles.gamma >= 0 && o.bundles.gamma <= 1, "gamma must be in [0, 1]");
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
