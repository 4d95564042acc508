// Files of compressed motion: the leaf models, skeletons and where every block of every clip is,
// then the blocks. What reads some frames reads their blocks alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kinetome/formats/skeleton.h"
#include "kinetome/models/compressed_motion.h"

namespace kinetome {

struct CompressedBlock {
    int64_t offset = 0;  ///< of its bytes, behind the head of the file
    int64_t bytes = 0;
    uint64_t hash = 0;  ///< of its bytes
};

struct CompressedClip {
    std::string name;
    int32_t skeleton = 0;  ///< of the file's
    double rate = 0;       ///< frames a second
    int64_t frames = 0;
    std::vector<CompressedBlock> blocks;
    MatrixF keys;  ///< degrees of freedom of the first frame of each block, and of the last frame
};

/// All but the blocks.
struct CompressedHead {
    MotionSteps steps;
    LeafBlend blend;
    int64_t block_frames = 256;
    LeafModels models;
    std::vector<std::shared_ptr<const Skeleton>> skeletons;
    std::vector<CompressedClip> clips;
    PoseErrors errors;  ///< of all frames, mm per marker

    int64_t frames() const;
};

/// Bytes of the parts of a file.
struct CompressedSize {
    int64_t file = 0;
    int64_t models = 0;
    int64_t blocks = 0;
    int64_t rest = 0;  ///< skeletons, keys, places of blocks

    /// Of all joint positions as 32-bit numbers, as a multiple of the file.
    double ratio(const CompressedHead& head) const;
};

/// `blocks`: those of all clips, one behind the other. Throws CreateError.
CompressedSize write_compressed(const std::filesystem::path& path, const CompressedHead& head,
                                const std::string& blocks);

class CompressedFile {
  public:
    /// Reads the head. Throws StoreError for what is no such file, or damaged.
    explicit CompressedFile(std::filesystem::path path);

    const CompressedHead& head() const { return head_; }
    const CompressedSize& size() const { return size_; }
    /// Throws UsageError naming the clips when there is none of that name, or, when it is "", not
    /// just one.
    const CompressedClip& find(const std::string& clip) const;
    /// Frames of blocks [first, end) of a clip. Throws StoreError.
    LeafFrames read(const CompressedClip& clip, int64_t first, int64_t end) const;

  private:
    std::filesystem::path path_;
    int64_t head_bytes_ = 0;
    CompressedSize size_;
    CompressedHead head_;
};

}  // namespace kinetome
