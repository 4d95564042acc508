// bundles: similar motions of every partition brought together, and the frames at which they begin
// and end (S1 §3.3–3.5).
#include <algorithm>
#include <tuple>

#include "kinetome/stages/bundle_file.h"
#include "kinetome/stages/partition_bundles.h"
#include "kinetome/stages/pose_cluster_file.h"
#include "kinetome/stages/pose_rows.h"
#include "kinetome/stages/stage.h"
#include "kinetome/stages/work_share.h"

namespace kinetome {
namespace {

/// Reach tables take a quarter of the memory granted at most: strings, poses and other ranks'
/// partitions need some too.
BundleResources bundle_resources(const StageContext& context, const Workers& workers) {
    BundleResources resources;
    resources.threads = workers.threads;
    resources.ranks = workers.ranks;
    resources.table_bytes = std::min(resources.table_bytes, context.resources.memory_bytes / 4);
    return resources;
}

/// Rounds follow from one another: ranks that share a partition go through all of them together,
/// and share the steps of its spread that are large (SimilarSubstrings).
PartitionBundles find(const StageContext& context, const PosePartition& partition,
                      const StoredMotionString& spelled, const StoredPoseClusters& model,
                      const Workers& workers) {
    context.stop.check();
    const auto poses = [&](int32_t clip, int64_t first, int64_t end) {
        context.stop.check();
        const int64_t row = partition.clips[static_cast<size_t>(clip)].first_row;
        return model.pca.project(partition.read({row + first, row + end}));
    };
    return find_partition_bundles(spelled, model.mixture, context.options.bundles,
                                  context.options.bundle_ends, bundle_resources(context, workers),
                                  poses);
}

/// Clips in name order, bundles in the order of their partitions.
StoredBundles joined(const std::vector<PosePartition>& partitions,
                     const std::vector<PartitionBundles>& found) {
    StoredBundles all;
    for (const PosePartition& partition : partitions) {
        all.pose_rate = partition.feature_class().pose_rate;
        for (const PartitionClip& clip : partition.clips) {
            all.clips.push_back({clip.place.name, partition.clip_class, clip.place.pose_rows,
                                 clip.place.source_frames, clip.place.source_rate});
        }
    }
    std::ranges::sort(all.clips, {}, &CutClip::name);
    for (size_t i = 0; i < partitions.size(); ++i) {
        const int32_t offset = all.bundles();
        all.partitions.push_back(partitions[i].path);
        all.partition_of.resize(static_cast<size_t>(offset + found[i].bundles),
                                static_cast<int32_t>(i));
        std::vector<int32_t> number_of;
        for (const PartitionClip& clip : partitions[i].clips) {
            const auto place =
                std::ranges::lower_bound(all.clips, clip.place.name, {}, &CutClip::name);
            number_of.push_back(static_cast<int32_t>(place - all.clips.begin()));
        }
        for (BundleMember member : found[i].members) {
            member.bundle += offset;
            member.frames.clip = number_of[static_cast<size_t>(member.frames.clip)];
            all.members.push_back(member);
        }
    }
    std::ranges::sort(all.members, {}, [](const BundleMember& member) {
        return std::tuple(member.frames.clip, member.frames.first);
    });
    return all;
}

void log_counts(const StageContext& context, const PosePartition& partition,
                const PartitionBundles& found) {
    std::vector<int64_t> heights(static_cast<size_t>(found.bundles));
    for (const BundleMember& member : found.members) ++heights[static_cast<size_t>(member.bundle)];
    int64_t several = 0, covered = 0;
    for (const int64_t height : heights) several += height > 1;
    for (const BundleMember& member : found.members) {
        if (heights[static_cast<size_t>(member.bundle)] > 1) covered += member.frames.frames();
    }
    context.log.info(
        "bundles {}: {} bundles hold {:.1f} % of {} frames; scores of their ends fell from {:.4g} "
        "to {:.4g}",
        partition.path, several,
        100 * static_cast<double>(covered) /
            static_cast<double>(std::max<int64_t>(1, partition.rows())),
        partition.rows(), found.first_score, found.end_score);
}

}  // namespace

StageResult make_bundles(const StageContext& context, const StageTask& task) {
    const ArtifactReader models = context.workspace.open(*task.inputs_of("pose_clusters").front());
    const ArtifactReader strings =
        context.workspace.open(*task.inputs_of("motion_strings").front());
    auto partitions = pose_partitions(context, task.inputs_of("features"));
    std::erase_if(partitions, [&](const PosePartition& partition) {  // too small to be clustered
        return !strings.contains(partition.path + "/letters/letter");
    });
    const auto found = for_partitions<PartitionBundles>(
        context.workers(), partitions, [&](size_t i, const Workers& workers) {
            return find(context, partitions[i], read_motion_string(strings, partitions[i].path),
                        read_pose_clusters(models, partitions[i].path), workers);
        });
    StageResult result;
    if (!context.is_root()) return result;
    for (size_t i = 0; i < partitions.size(); ++i) log_counts(context, partitions[i], found[i]);
    ArtifactWriter file(task.output, task.header, context.writing());
    write_bundles(file, joined(partitions, found));
    result.file = file.close();
    return result;
}

}  // namespace kinetome
