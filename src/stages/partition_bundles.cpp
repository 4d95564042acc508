#include "kinetome/stages/partition_bundles.h"

#include <algorithm>

#include "kinetome/base/pack_fields.h"

namespace kinetome {
namespace {

/// Poses of F(j) for every letter asked for, one after another. Letters are ascending; those of a
/// clip are read together.
MatrixF poses_of(const MotionString& string, std::span<const int32_t> letters, int64_t columns,
                 const PoseReader& read) {
    const auto first = [&](size_t i) {
        return string.first_frame[static_cast<size_t>(letters[i])];
    };
    const auto end = [&](size_t i) { return string.end_frame[static_cast<size_t>(letters[i])]; };
    const auto clip = [&](size_t i) { return string.clip[static_cast<size_t>(letters[i])]; };
    Eigen::Index rows = 0;
    for (size_t i = 0; i < letters.size(); ++i) rows += end(i) - first(i);
    MatrixF poses(rows, columns);
    Eigen::Index done = 0;
    for (size_t i = 0; i < letters.size();) {
        size_t next = i;
        while (next < letters.size() && clip(next) == clip(i)) ++next;
        const MatrixF of_clip = read(clip(i), first(i), end(next - 1));
        const int32_t offset = first(i);
        for (; i < next; ++i) {
            const Eigen::Index count = end(i) - first(i);
            poses.middleRows(done, count) = of_clip.middleRows(first(i) - offset, count);
            done += count;
        }
    }
    return poses;
}

}  // namespace

PartitionBundles find_partition_bundles(const StoredMotionString& spelled, const Mixture& mixture,
                                        const MotionBundleOptions& options,
                                        const BundleEndOptions& ends,
                                        const BundleResources& resources, const PoseReader& poses) {
    const MotionString& string = spelled.string;
    const auto bundles = find_motion_bundles(
        string, accessibility_for_bundles(spelled.accessibility, string, mixture, options),
        spelled.lambda, options, resources);
    if (resources.ranks && !resources.ranks->is_root()) return {};
    const auto letters = bundle_end_letters(bundles);
    const BundleEnds found = find_bundle_ends(
        string, bundles, letters, poses_of(string, letters, mixture.dimension(), poses), ends);
    return {bundle_members(string, bundles, found.frames), static_cast<int32_t>(bundles.size()),
            found.first_score, found.score};
}

void pack(Packer& out, const PartitionBundles& bundles) {
    pack_each(out, bundles.members, [&](const BundleMember& one) {
        pack_all(out, one.bundle, one.frames.clip, one.frames.first, one.frames.end);
    });
    pack_all(out, bundles.bundles, bundles.first_score, bundles.end_score);
}

void unpack(Unpacker& in, PartitionBundles& bundles) {
    unpack_each(in, bundles.members, [&](BundleMember& one) {
        unpack_all(in, one.bundle, one.frames.clip, one.frames.first, one.frames.end);
    });
    unpack_all(in, bundles.bundles, bundles.first_score, bundles.end_score);
}

}  // namespace kinetome
