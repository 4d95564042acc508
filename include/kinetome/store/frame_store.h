// The frame store: shards of clips with their skeletons, degrees of freedom and joint positions.
// One HDF5 group a class of skeletons; layout in docs/artifacts.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "kinetome/formats/clip.h"
#include "kinetome/store/artifact.h"

namespace kinetome {

/// A clip as the frame store keeps it.
struct StoredClip {
    std::string name;
    Clip clip;          ///< at the source's rate
    MatrixF positions;  ///< frames × 3·joints, cm, world, Y up
};

/// Writes the clips of one shard, in name order.
class FrameShardWriter {
  public:
    FrameShardWriter(const std::filesystem::path& path, const ArtifactHeader& header,
                     const WriteOptions& options);
    void add(const StoredClip& clip);
    ArtifactRecord close();

  private:
    void begin_class(const std::string& name, const Skeleton& skeleton);

    ArtifactWriter file_;
    std::map<std::string, int64_t> classes_;  ///< class name → clips so far
};

/// One clip's place in a shard.
struct FrameShardClip {
    std::string name;
    std::string clip_class;
    int64_t first_row = 0;  ///< in the class's matrices of this file
    int64_t frames = 0;
    double rate = 0;  ///< frames a second
};

class FrameShardReader {
  public:
    explicit FrameShardReader(ArtifactReader file);

    /// In name order.
    const std::vector<FrameShardClip>& clips() const { return clips_; }
    /// Reads the i-th clip whole.
    StoredClip read(size_t i) const;

  private:
    ArtifactReader file_;
    std::vector<FrameShardClip> clips_;
    std::vector<int64_t> row_in_class_;  ///< of each clip in its class's clip table
};

}  // namespace kinetome
