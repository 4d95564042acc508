// The neighbour store: shards of neighbourhood graphs (S3 §3), each take by itself or all takes of
// a class together; one HDF5 group a class of skeletons; layout in docs/artifacts.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "kinetome/store/artifact.h"

namespace kinetome {

/// A clip whose graph is stored.
struct NeighborClip {
    std::string name;
    std::string clip_class;
    int64_t source_frames = 0;
    double source_rate = 0;  ///< frames a second
    double radius = 0;       ///< cm, that its neighbours were searched within
};

enum class NeighborScope {
    take,    ///< neighbours are frames of the same clip
    corpus,  ///< neighbours are frames of any clip of the class
};

/// Frame i of a clip has neighbours [offsets[i], offsets[i + 1]), by clip and frame.
struct StoredNeighbors {
    std::vector<int64_t> offsets;     ///< frames + 1
    std::vector<int32_t> neighbours;  ///< frames of a clip, at the effector rate
    std::vector<float> distances;     ///< cm, of stacked features
    std::vector<int64_t> clips{};     ///< id of each neighbour's clip; empty of NeighborScope::take
};

/// Writes the graphs of one shard, clips of a class in name order.
class NeighborShardWriter {
  public:
    /// `effector_rate`: frames a second that frames count at.
    NeighborShardWriter(const std::filesystem::path& path, const ArtifactHeader& header,
                        const WriteOptions& options, double effector_rate,
                        NeighborScope scope = NeighborScope::take);
    /// The arrays are those of StoredNeighbors.
    void add(const NeighborClip& clip, std::span<const int64_t> offsets,
             std::span<const int32_t> neighbours, std::span<const float> distances,
             std::span<const int64_t> clips = {});
    ArtifactRecord close();

  private:
    void begin_class(const std::string& name);

    ArtifactWriter file_;
    double effector_rate_;
    NeighborScope scope_;
    std::set<std::string> classes_;
};

/// One clip's place in a shard.
struct NeighborShardClip {
    NeighborClip clip;
    int64_t first_frame = 0;  ///< in the class's neighbour_count of this file
    int64_t frames = 0;       ///< at the effector rate
    int64_t first_edge = 0;   ///< in the class's neighbour and distance of this file
    int64_t edges = 0;
};

/// Thread-safe.
class NeighborShardReader {
  public:
    explicit NeighborShardReader(ArtifactReader file);

    /// Class by class, in name order inside each.
    const std::vector<NeighborShardClip>& clips() const { return clips_; }
    /// The graph of the i-th clip.
    StoredNeighbors read(size_t i) const;
    /// Frames a second that frames of a class count at.
    double effector_rate(const std::string& clip_class) const;

  private:
    ArtifactReader file_;
    std::vector<NeighborShardClip> clips_;
};

}  // namespace kinetome
