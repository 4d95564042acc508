// Every option of `reindex`, one struct a stage, and one table that names them all: flags, keys of
// the configuration file, config.toml and stage keys are made from its rows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "kinetome/features/effectors.h"
#include "kinetome/formats/asf_amc.h"
#include "kinetome/math/knn.h"
#include "kinetome/models/activity.h"
#include "kinetome/models/alternations.h"
#include "kinetome/models/bundle_ends.h"
#include "kinetome/models/bundle_options.h"
#include "kinetome/models/hierarchy_growth.h"
#include "kinetome/models/motion_string.h"
#include "kinetome/models/pose_clusters.h"
#include "kinetome/models/primitive.h"
#include "kinetome/models/principal_markers.h"
#include "kinetome/models/subject_partition.h"

namespace kinetome {

struct FrameOptions {
    AmcOptions amc;                 ///< reading of AMC takes
    std::string joint_map;          ///< TOML file that names the joints of an unknown rig; "" none
    int64_t shard_frames = 65'536;  ///< mean frames of a shard
    std::string compression = "none";  ///< of artifacts: none, gzip, blosc
};

struct FeatureOptions {
    double pose_rate = 120;               ///< frames a second of pose vectors and markers (S1)
    double effector_rate = 30;            ///< frames a second of effector features (S3)
    double velocity_reach = 2.0 / 120.0;  ///< seconds to either side of a velocity's difference
};

struct PartitionOptions {
    PartitionRule rule = PartitionRule::automatic;  ///< which clips share pose clusters
    std::string subject_from;  ///< expression on a take's path whose first group is its subject
};

struct NeighborOptions {
    KnnOptions knn;                        ///< r in cm for all effectors (S3: 64), and k
    KnnEngine engine = KnnEngine::blocks;  ///< that searches
    double stack_offset = 1.0 / 30.0;      ///< seconds between the poses stacked in one row
    /// Compared; r is scaled to their number (radius_for_effectors).
    std::vector<JointRole> joints{effector_roles.begin(), effector_roles.end()};
    double adapt_radius = 0;  ///< r at most so many median distances of a take; 0: r as it is
};

struct CorpusNeighborOptions {
    bool wanted = false;  ///< the graph of all takes together
    double exclusion =
        0;  ///< seconds: frames of the same take that are nearer in time are left out
};

struct ReindexOptions {
    FrameOptions frames;
    FeatureOptions features;
    PartitionOptions partition;
    PoseClusterOptions pose_clusters;
    MotionStringOptions motion_strings;
    PrincipalMarkerOptions principal_markers;
    PoseHierarchyOptions pose_hierarchy;
    MotionBundleOptions bundles;
    BundleEndOptions bundle_ends;
    NeighborOptions neighbors;
    CorpusNeighborOptions corpus_neighbors;
    ActivityOptions activities;
    PrimitiveOptions primitives;
    PrimitiveClusterOptions primitive_clusters;
    AlternationOptions alternations;
};

/// Every option at the paper's value, where the default departs from it (docs/methods.md).
ReindexOptions paper_options();

/// What a value looks like in a configuration file.
enum class OptionKind { number, text };

/// One option: bound to the ReindexOptions it was made from, which must outlive it.
struct OptionRow {
    std::string name;   ///< "shard-frames"
    std::string stage;  ///< the first stage whose result it changes; "" when it changes none
    OptionKind kind;
    std::string help;
    std::function<std::string()> get;
    /// Throws UsageError naming option and text.
    std::function<void(const std::string&)> set;
};

std::vector<OptionRow> option_rows(ReindexOptions& options);

/// Reads a configuration file over `options`; returns the names it set. Throws UsageError naming
/// file and line for a syntax error, an unknown name or a bad value.
std::set<std::string> read_configuration(const std::filesystem::path& file,
                                         ReindexOptions& options);

/// All options as a configuration file, defaults written out, with their help as comments.
std::string write_configuration(const ReindexOptions& options);
/// The text form back; `origin` is named in errors.
std::set<std::string> parse_configuration(std::string_view toml, const std::string& origin,
                                          ReindexOptions& options);

/// Throws UsageError when values contradict each other or are out of range.
void check_options(const ReindexOptions& options);

}  // namespace kinetome
