#include "kinetome/stages/subject_links.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "clip_pipeline.h"
#include "kinetome/base/shared_items.h"
#include "kinetome/models/bundle_link_rows.h"
#include "kinetome/store/frame_store.h"

namespace kinetome {
namespace {

/// By clip: the partition that its bundles with several members are of; -1 without any.
std::vector<int32_t> partitions_of_clips(const StoredBundles& bundles,
                                         const std::vector<int32_t>& heights) {
    std::vector<int32_t> partitions(bundles.clips.size(), -1);
    for (const BundleMember& member : bundles.members) {
        const auto bundle = static_cast<size_t>(member.bundle);
        if (heights[bundle] > 1)
            partitions[static_cast<size_t>(member.frames.clip)] = bundles.partition_of[bundle];
    }
    return partitions;
}

/// Clips by class, in name order; only those of several partitions.
std::map<std::string, std::vector<size_t>> clips_of_several(
    const StoredBundles& bundles, const std::vector<int32_t>& partitions) {
    std::map<std::string, std::vector<size_t>> clips;
    std::map<std::string, std::set<int32_t>> of_class;
    for (size_t clip = 0; clip < partitions.size(); ++clip) {
        if (partitions[clip] < 0) continue;
        clips[bundles.clips[clip].clip_class].push_back(clip);
        of_class[bundles.clips[clip].clip_class].insert(partitions[clip]);
    }
    std::erase_if(clips, [&](const auto& one) { return of_class.at(one.first).size() < 2; });
    return clips;
}

struct Passenger {
    StoredClip stored;
    size_t clip = 0;
    MatrixF rows = {};
};

/// Rows of those clips that it is this rank's turn to read, by clip; none where the skeleton lacks
/// a joint.
std::vector<MatrixF> read_own_rows(const StageContext& context,
                                   const std::vector<const FinishedWork*>& frames,
                                   const std::map<std::string, size_t>& wanted, size_t clips) {
    constexpr uint64_t bytes_per_frame = 2 * 1024;  // a frame and its positions, at two rates
    const auto ranks = static_cast<size_t>(context.workers().rank_count());
    const auto rank = static_cast<size_t>(context.workers().rank());
    std::vector<MatrixF> rows(clips);
    for (const FinishedWork* work : frames) {
        context.check_ranks();
        const FrameShardReader shard(context.workspace.open(*work));
        uint64_t largest = 0;
        for (const FrameShardClip& clip : shard.clips())
            largest = std::max(largest, static_cast<uint64_t>(clip.frames) * bytes_per_frame);
        size_t next = 0;
        const auto read = [&]() -> std::shared_ptr<Passenger> {
            for (; next < shard.clips().size(); ++next) {
                const auto found = wanted.find(shard.clips()[next].name);
                if (found != wanted.end() && found->second % ranks == rank)
                    return std::make_shared<Passenger>(
                        Passenger{shard.read(next++), found->second});
            }
            return nullptr;
        };
        const auto compute = [](Passenger& one) {
            if (has_bundle_link_rows(*one.stored.clip.skeleton))
                one.rows = bundle_link_rows(one.stored.clip);
        };
        const auto keep = [&](Passenger& one) { rows[one.clip] = std::move(one.rows); };
        run_clip_pipeline<Passenger>(clips_in_flight(context.resources, largest), context.stop,
                                     read, compute, keep);
    }
    return rows;
}

/// What link_bundles asks for, of one class.
struct ComparedClips {
    MatrixF rows;
    std::vector<RowRange> clips;
    std::vector<int32_t> subject_of;
    std::vector<BundleMember> members;
};

/// A member in rows of its clip: those that it reaches into.
MotionPiece in_rows(const MotionPiece& frames, int32_t clip, double rows_per_frame, int64_t rows) {
    const auto first = static_cast<int64_t>(static_cast<double>(frames.first) * rows_per_frame);
    const auto end = std::llround(std::ceil(static_cast<double>(frames.end) * rows_per_frame));
    const int64_t from = std::min(first, rows - 1);
    return {clip, from, std::clamp<int64_t>(end, from + 1, rows)};
}

ComparedClips compared_clips(const StoredBundles& bundles, const std::vector<int32_t>& heights,
                             const std::vector<int32_t>& partitions,
                             const std::vector<size_t>& clips, std::vector<MatrixF>& rows) {
    ComparedClips all;
    Eigen::Index count = 0, columns = 0;
    for (const size_t clip : clips) {
        count += rows[clip].rows();
        columns = std::max(columns, rows[clip].cols());
    }
    all.rows.resize(count, columns);
    std::map<int32_t, int32_t> number_of;
    int64_t first = 0;
    for (const size_t clip : clips) {
        const int64_t end = first + rows[clip].rows();
        if (first == end) continue;
        all.rows.middleRows(first, end - first) = rows[clip];
        rows[clip].resize(0, 0);
        number_of[static_cast<int32_t>(clip)] = static_cast<int32_t>(all.clips.size());
        all.clips.push_back({first, end});
        all.subject_of.push_back(partitions[clip]);
        first = end;
    }
    for (const BundleMember& member : bundles.members) {
        const auto clip = number_of.find(member.frames.clip);
        if (clip == number_of.end() || heights[static_cast<size_t>(member.bundle)] < 2) continue;
        all.members.push_back(
            {member.bundle,
             in_rows(member.frames, clip->second, bundle_link_rate / bundles.pose_rate,
                     all.clips[static_cast<size_t>(clip->second)].size())});
    }
    return all;
}

}  // namespace

std::vector<BundleLink> link_subjects(const StageContext& context,
                                      const std::vector<const FinishedWork*>& frames,
                                      const StoredBundles& bundles) {
    const std::vector<int32_t> heights = bundles.heights();
    const std::vector<int32_t> partitions = partitions_of_clips(bundles, heights);
    const auto classes = clips_of_several(bundles, partitions);
    if (classes.empty()) return {};
    std::map<std::string, size_t> wanted;
    for (const auto& [name, clips] : classes) {
        for (const size_t clip : clips) wanted[bundles.clips[clip].name] = clip;
    }
    std::vector<MatrixF> rows = read_own_rows(context, frames, wanted, bundles.clips.size());
    exchange_by_turns(rows, context.workers());
    std::vector<BundleLink> links;
    for (const auto& [name, clips] : classes) {
        const ComparedClips all = compared_clips(bundles, heights, partitions, clips, rows);
        const auto found =
            link_bundles(all.rows, all.clips, all.members, all.subject_of, {}, context.workers());
        links.insert(links.end(), found.links.begin(), found.links.end());
    }
    std::ranges::sort(links, {},
                      [](const BundleLink& link) { return std::pair(link.first, link.second); });
    return links;
}

}  // namespace kinetome
