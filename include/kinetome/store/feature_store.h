// The feature store: shards of pose vectors, effector features and marker sets, one HDF5 group a
// class of skeletons; layout in docs/artifacts.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/store/artifact.h"

namespace kinetome {

/// Features of one clip.
struct ClipFeatures {
    std::string name;
    std::string clip_class;
    int64_t source_frames = 0;
    double source_rate = 0;  ///< frames a second
    MatrixF pose_vectors;    ///< n × columns at the pose rate
    MatrixF markers;         ///< n × 3·joints at the pose rate, cm
    MatrixF effectors;  ///< m × 15 at the effector rate, cm; no rows: none of its clips has them
};

/// What all clips of a class share.
struct FeatureClass {
    std::vector<std::string> pose_vector_names;  ///< of the columns of pose_vectors
    std::vector<std::string> pose_vector_units;
    std::vector<double> pose_vector_floors;  ///< least scale of each, in its unit
    std::vector<std::string> marker_names;   ///< one a joint
    double pose_rate = 0;                    ///< frames a second
    double effector_rate = 0;
};

/// Writes the features of one shard, clips in name order.
class FeatureShardWriter {
  public:
    FeatureShardWriter(const std::filesystem::path& path, const ArtifactHeader& header,
                       const WriteOptions& options);
    void begin_class(const std::string& name, const FeatureClass& shared);
    bool has_class(const std::string& name) const { return classes_.count(name) > 0; }
    void add(const ClipFeatures& clip);
    ArtifactRecord close();

  private:
    ArtifactWriter file_;
    std::map<std::string, FeatureClass> classes_;
};

/// One clip's place in a shard.
struct FeatureShardClip {
    std::string name;
    std::string clip_class;
    int64_t source_frames = 0;
    double source_rate = 0;
    int64_t first_pose_row = 0;  ///< in this file's pose_vectors and markers of the class
    int64_t pose_rows = 0;
    int64_t first_effector_row = 0;
    int64_t effector_rows = 0;
};

/// Thread-safe.
class FeatureShardReader {
  public:
    explicit FeatureShardReader(ArtifactReader file);

    /// Class by class, in name order inside each.
    const std::vector<FeatureShardClip>& clips() const { return clips_; }
    FeatureClass feature_class(const std::string& name) const;
    MatrixF pose_vectors(const std::string& clip_class, int64_t first, int64_t count) const;
    MatrixF markers(const std::string& clip_class, int64_t first, int64_t count) const;
    MatrixF effectors(const std::string& clip_class, int64_t first, int64_t count) const;

  private:
    ArtifactReader file_;
    std::vector<FeatureShardClip> clips_;
};

}  // namespace kinetome
