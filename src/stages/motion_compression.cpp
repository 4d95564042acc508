#include "kinetome/stages/motion_compression.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "kinetome/base/digest.h"
#include "kinetome/base/error.h"
#include "kinetome/base/packing.h"
#include "kinetome/features/markers.h"
#include "kinetome/formats/skeleton_packing.h"
#include "kinetome/models/skeleton_fit.h"
#include "kinetome/stages/pose_hierarchy_file.h"
#include "kinetome/stages/stored_clips.h"

namespace kinetome {
namespace {

std::string class_of(const StoredClips& stored, const std::vector<std::string>& clips) {
    if (clips.empty())
        throw UsageError("no clip to compress: kinetome export STORE clips lists them");
    const std::string found = stored.find(clips.front()).clip_class;
    for (const std::string& clip : clips) {
        const std::string other = stored.find(clip).clip_class;
        if (other == found) continue;
        throw UsageError(
            fmt::format("clips of several classes ({} and {}) share no model: compress them apart",
                        found, other));
    }
    return found;
}

MatrixF poses_of(const StoredClip& clip) {
    return normalised_markers(*clip.clip.skeleton, clip.clip.motion, clip.positions);
}

std::vector<int32_t> leaves_in(const PoseHierarchy& hierarchy, StoredClips& stored,
                               const std::vector<std::string>& clips) {
    std::set<int32_t> leaves;
    for (const std::string& clip : clips) {
        for (const int32_t leaf : leaves_of(hierarchy, poses_of(stored.read(clip)))) {
            leaves.insert(leaf);
        }
    }
    return {leaves.begin(), leaves.end()};
}

/// The number of a skeleton among those of the file, which it is added to when it is new.
int32_t number_of(const std::shared_ptr<const Skeleton>& skeleton, CompressedHead& head) {
    const std::string bytes = packed(*skeleton);
    const auto known = std::ranges::find_if(
        head.skeletons, [&](const auto& other) { return packed(*other) == bytes; });
    const auto number = static_cast<int32_t>(known - head.skeletons.begin());
    if (known == head.skeletons.end()) head.skeletons.push_back(skeleton);
    return number;
}

LeafFrames rows_of(const LeafFrames& frames, const RowRange& rows) {
    return {{frames.models.begin() + rows.first, frames.models.begin() + rows.end},
            frames.coordinates.middleRows(rows.first, rows.size()),
            frames.root.middleRows(rows.first, rows.size())};
}

/// Adds a clip to the head, its blocks to `blocks`, and what is lost to `errors`.
void add_clip(const StoredClip& stored, const PoseHierarchy& hierarchy, CompressedHead& head,
              std::string& blocks, std::vector<double>& errors) {
    const MatrixF poses = poses_of(stored);
    const LeafFrames frames =
        on_leaves(hierarchy, head.models, poses, root_track(stored.positions, poses));
    CompressedClip clip;
    clip.name = stored.name;
    clip.skeleton = number_of(stored.clip.skeleton, head);
    clip.rate = stored.clip.rate;
    clip.frames = poses.rows();
    const int64_t count = (clip.frames + head.block_frames - 1) / head.block_frames;
    clip.keys.resize(count + 1, stored.clip.motion.cols());
    LeafFrames decoded{{}, MatrixD(clip.frames, head.models.dimension()), frames.root};
    for (int64_t b = 0; b < count; ++b) {
        const RowRange rows{b * head.block_frames,
                            std::min((b + 1) * head.block_frames, clip.frames)};
        const std::string bytes = encode_block(rows_of(frames, rows), head.steps);
        clip.blocks.push_back({std::ssize(blocks), std::ssize(bytes), digest_of(bytes).low});
        clip.keys.row(b) = stored.clip.motion.row(rows.first);
        const LeafFrames again = decode_block(bytes, head.models, head.steps);
        decoded.models.insert(decoded.models.end(), again.models.begin(), again.models.end());
        decoded.coordinates.middleRows(rows.first, rows.size()) = again.coordinates;
        blocks += bytes;
    }
    clip.keys.row(count) = stored.clip.motion.row(clip.frames - 1);
    const auto lost = errors_of(poses, poses_of(decoded, head.models, head.blend));
    errors.insert(errors.end(), lost.begin(), lost.end());
    head.clips.push_back(std::move(clip));
}

/// Frames that a range needs, and the blocks that hold them.
struct Needed {
    RowRange frames;  ///< asked for
    RowRange blocks;
    int64_t first_frame;  ///< of the first block
};

Needed needed_for(const CompressedHead& head, const CompressedClip& clip, const RowRange& frames) {
    const int64_t margin = head.blend.margin();
    const int64_t first = std::max<int64_t>(frames.first - margin, 0) / head.block_frames;
    const int64_t last = std::min(frames.end + margin, clip.frames) - 1;
    return {frames, {first, last / head.block_frames + 1}, first * head.block_frames};
}

RowRange asked_frames(const CompressedClip& clip, const std::optional<RowRange>& frames) {
    const RowRange asked = frames.value_or(RowRange{0, clip.frames});
    if (asked.first < 0 || asked.first >= asked.end || asked.end > clip.frames) {
        throw UsageError(fmt::format("--frames {}:{}: expected a part of 0:{}", asked.first,
                                     asked.end, clip.frames));
    }
    return asked;
}

struct DecodedPoses {
    MatrixF poses;
    MatrixD root;
};

DecodedPoses decoded(const CompressedFile& file, const CompressedClip& clip,
                     const RowRange& frames) {
    const CompressedHead& head = file.head();
    const Needed needed = needed_for(head, clip, frames);
    const LeafFrames read = file.read(clip, needed.blocks.first, needed.blocks.end);
    const int64_t skip = frames.first - needed.first_frame;
    return {poses_of(read, head.models, head.blend).middleRows(skip, frames.size()),
            read.root.middleRows(skip, frames.size())};
}

/// Angles of `later` a whole number of turns nearer to those of `earlier`.
std::vector<float> unwrapped(const Skeleton& skeleton, std::span<const float> earlier,
                             std::span<const float> later) {
    std::vector<float> result(later.begin(), later.end());
    size_t dof = 0;
    for (const Joint& joint : skeleton.joints()) {
        for (const Channel channel : joint.channels) {
            if (is_rotation(channel)) {
                const double turn = double(later[dof]) - double(earlier[dof]);
                result[dof] = static_cast<float>(double(earlier[dof]) +
                                                 std::remainder(turn, 2 * std::numbers::pi));
            }
            ++dof;
        }
    }
    return result;
}

std::span<const float> row_of(const MatrixF& rows, int64_t row) {
    return {rows.data() + row * rows.cols(), static_cast<size_t>(rows.cols())};
}

}  // namespace

double paper_ratio(const CompressedHead& head) {
    const auto frames = static_cast<double>(head.frames());
    const auto columns = static_cast<double>(head.models.columns());
    const auto leaves = static_cast<double>(head.models.size());
    const auto dimension = static_cast<double>(head.models.dimension());
    return frames * columns / (leaves * columns * dimension + frames * dimension);
}

CompressedMotion compress_clips(const Generation& generation, const std::vector<std::string>& clips,
                                const std::filesystem::path& output) {
    StoredClips stored(generation);
    const std::string group = "/" + class_of(stored, clips);
    const PoseHierarchy hierarchy =
        read_pose_hierarchy(generation.open("pose_hierarchy.h5"), group).hierarchy;
    CompressedMotion result;
    result.head.models = LeafModels(hierarchy, leaves_in(hierarchy, stored, clips));
    std::string blocks;
    std::vector<double> errors;
    for (const std::string& clip : clips) {
        add_clip(stored.read(clip), hierarchy, result.head, blocks, errors);
    }
    result.head.errors = summary_of(std::move(errors));
    result.size = write_compressed(output, result.head, blocks);
    result.paper_ratio = paper_ratio(result.head);
    return result;
}

MatrixF decompressed_poses(const CompressedFile& file, const CompressedClip& clip,
                           const std::optional<RowRange>& frames) {
    return decoded(file, clip, asked_frames(clip, frames)).poses;
}

Clip decompressed_motion(const CompressedFile& file, const CompressedClip& clip,
                         const std::optional<RowRange>& frames, int threads) {
    const CompressedHead& head = file.head();
    const RowRange asked = asked_frames(clip, frames);
    // Each block is fitted from its first frame on, whatever is asked for of it.
    const int64_t first_block = asked.first / head.block_frames;
    const int64_t first_frame = first_block * head.block_frames;
    const auto [poses, root] = decoded(file, clip, {first_frame, asked.end});
    const MatrixF positions = world_positions(poses, root);
    const auto skeleton = head.skeletons[static_cast<size_t>(clip.skeleton)];
    MatrixF motion(positions.rows(), skeleton->dof_count());
    const int64_t blocks = (positions.rows() + head.block_frames - 1) / head.block_frames;
    tbb::task_arena(threads).execute([&] {
        tbb::parallel_for(int64_t{0}, blocks, [&](int64_t b) {
            const int64_t key = first_block + b, row = b * head.block_frames;
            const int64_t rows = std::min(head.block_frames, positions.rows() - row);
            // The last key is that of the last frame itself.
            const int64_t whole = std::min(
                head.block_frames, std::max<int64_t>(1, clip.frames - 1 - first_frame - row));
            const auto start = row_of(clip.keys, key);
            SkeletonFit fit(skeleton);
            motion.middleRows(row, rows) =
                fit_frames(fit, positions.middleRows(row, rows), start,
                           unwrapped(*skeleton, start, row_of(clip.keys, key + 1)), whole);
        });
    });
    return {skeleton, motion.middleRows(asked.first - first_frame, asked.size()), clip.rate};
}

}  // namespace kinetome
