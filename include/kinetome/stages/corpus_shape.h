// How large a corpus is in what costs time and space: frames, columns and partitions, known before
// any motion is read.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "kinetome/run/shard_plan.h"
#include "kinetome/stages/options.h"
#include "kinetome/stages/pose_hierarchy_memory.h"
#include "kinetome/stages/survey.h"
#include "kinetome/store/catalog.h"

namespace kinetome {

/// A class of skeletons. The defaults are CMU's, for takes whose skeleton is not known yet.
struct ClassShape {
    std::string name;
    int64_t joints = 31;
    int64_t dofs = 62;
    int64_t pose_columns = 62;
};

/// Of effector features at one frame: five joints.
inline constexpr int64_t effector_values = 15;

/// Numbers that the artifacts hold of one frame at the source's rate.
double values_of_frames(const ClassShape& shape);
double values_of_features(const ClassShape& shape, const FeatureOptions& options, double rate);

/// Whether a stage that makes one file works take by take, not by partitions of poses.
bool goes_through_takes(std::string_view stage);
/// Whether it works on the letters of a partition, which are few, not on its poses.
bool goes_through_bundles(std::string_view stage);
/// Letters of a partition's string, as long as nothing is spelled.
int64_t expected_letters(int64_t rows);

struct ClipShape {
    std::string name;
    std::string source;  ///< path below the corpus, which may tell the subject
    size_t clip_class = 0;
    int64_t frames = 0;  ///< at the source's rate
    double rate = 0;     ///< frames a second
    uint64_t source_bytes = 0;

    int64_t frames_at(double other_rate) const;
};

struct CorpusShape {
    std::vector<ClassShape> classes;
    std::vector<ClipShape> clips;                       ///< in name order
    std::map<std::string, std::vector<size_t>> shards;  ///< cut → its clips

    const ClassShape& class_of(const ClipShape& clip) const { return classes[clip.clip_class]; }
    int64_t frames() const;
    /// Frames of each class at another rate.
    std::vector<int64_t> class_frames_at(double rate) const;
};

/// Neighbours that all frames of a take have together, as long as none is searched. How many poses
/// of a take are alike differs from take to take by half as much again or less.
double expected_edges(const ClipShape& clip, const ReindexOptions& options);
/// The same in the graph of all takes, in which most lists are full; its class has `class_frames`
/// frames at the effector rate.
double expected_corpus_edges(const ClipShape& clip, int64_t class_frames,
                             const ReindexOptions& options);

/// What the takes claim; those that the survey quarantined, or whose skeleton cannot be parsed, are
/// left out. Skeleton files are read, takes are not.
CorpusShape corpus_shape(const Survey& survey, const std::vector<Shard>& shards,
                         const ReindexOptions& options);
/// What a generation holds.
CorpusShape corpus_shape(const Catalog& catalog);

/// Poses that will be clustered together.
struct PartitionShape {
    int64_t clips = 0;
    int64_t rows = 0;    ///< pose vectors
    int64_t pieces = 0;  ///< that ranks can share (base/pieces.h)
    int64_t pose_columns = 0;
    std::vector<int64_t> cluster_counts;  ///< every κ that is fitted

    int64_t most_clusters() const;
    /// Principal components that will be kept, as long as nothing is fitted: more motion is more
    /// varied. Of CMU's subjects alone 4 to 15 are kept, of all together 17.
    int64_t expected_components() const;
};

/// Poses of one class, whose hierarchy will be grown.
struct HierarchyShape {
    int64_t clips = 0;
    int64_t pieces = 0;  ///< that ranks can share (base/pieces.h)
    HierarchySize size;  ///< with as many principal columns as real motion has
};

/// One a class that has poses.
std::vector<HierarchyShape> hierarchy_shapes(const CorpusShape& corpus,
                                             const ReindexOptions& options);

/// As pose_partitions will make them; those too small to be clustered are left out.
std::vector<PartitionShape> partition_shapes(const CorpusShape& corpus,
                                             const ReindexOptions& options);

}  // namespace kinetome
