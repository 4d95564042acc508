// signatures: every take as the leaves of the pose hierarchy that it passes through, and the index
// that sub-motions are searched in (S2 §5.3).
#include <algorithm>

#include "clip_pipeline.h"
#include "kinetome/base/pack_fields.h"
#include "kinetome/stages/pose_hierarchy_file.h"
#include "kinetome/stages/pose_rows.h"
#include "kinetome/stages/signature_file.h"
#include "kinetome/stages/stage.h"
#include "kinetome/stages/work_share.h"

namespace kinetome {

namespace {

/// Signatures of a rank's clips, by number.
struct SignatureShare {
    std::vector<int32_t> clips;
    std::vector<PlacedSignature> signatures;
};

void pack(Packer& out, const SignatureShare& share) {
    pack(out, share.clips);
    for (const PlacedSignature& signature : share.signatures) {
        pack_each(out, signature.runs, [&](const SignatureRun& run) {
            pack_all(out, run.leaf, run.first_frame, run.frames);
        });
        pack_all(out, signature.positions, signature.stride, signature.sample_positions);
    }
}

void unpack(Unpacker& in, SignatureShare& share) {
    unpack(in, share.clips);
    share.signatures.resize(share.clips.size());
    for (PlacedSignature& signature : share.signatures) {
        unpack_each(in, signature.runs, [&](SignatureRun& run) {
            unpack_all(in, run.leaf, run.first_frame, run.frames);
        });
        unpack_all(in, signature.positions, signature.stride, signature.sample_positions);
    }
}

SignatureShare share_of_rank(const StageContext& context, const PosePartition& partition,
                             const PoseHierarchy& hierarchy, const MatrixF& axes) {
    std::vector<int64_t> frames;
    for (const PartitionClip& clip : partition.clips) frames.push_back(clip.place.pose_rows);
    const Workers workers = context.workers();
    const std::vector<int> owners = share_out(frames, workers.rank_count(), false);
    SignatureShare share;
    int64_t longest = 0;
    for (size_t i = 0; i < owners.size(); ++i) {
        if (owners[i] != workers.rank()) continue;
        share.clips.push_back(static_cast<int32_t>(i));
        longest = std::max(longest, frames[i]);
    }
    share.signatures.resize(share.clips.size());
    const int32_t stride = sample_stride(partition.feature_class().pose_rate);
    const auto clip_bytes = static_cast<uint64_t>(longest * hierarchy.columns()) * sizeof(float);
    size_t next = 0;
    run_clip_pipeline<const size_t>(
        clips_in_flight(context.resources, 2 * clip_bytes), context.stop,
        [&]() -> std::shared_ptr<const size_t> {
            return next < share.clips.size() ? std::make_shared<const size_t>(next++) : nullptr;
        },
        [&](size_t i) {
            const PartitionClip& clip = partition.clips[static_cast<size_t>(share.clips[i])];
            const RowRange rows{clip.first_row, clip.first_row + clip.place.pose_rows};
            if (rows.size() == 0) return;
            const MatrixF markers = partition.read_markers(rows);
            share.signatures[i] = place_signature(make_signature(leaves_of(hierarchy, markers)),
                                                  markers, axes, stride);
        },
        [](size_t) {});
    return share;
}

/// Of all clips at rank 0, of none elsewhere.
std::vector<PlacedSignature> signatures_of(const StageContext& context,
                                           const PosePartition& partition,
                                           const PoseHierarchy& hierarchy, const MatrixF& axes) {
    std::vector<SignatureShare> shares{share_of_rank(context, partition, hierarchy, axes)};
    const Workers workers = context.workers();
    if (workers.rank_count() > 1) {
        const auto brought = workers.ranks->gather(packed(shares.front()));
        if (!workers.is_root()) return {};
        for (int rank = 1; rank < workers.rank_count(); ++rank) {
            shares.push_back(unpacked<SignatureShare>(brought[static_cast<size_t>(rank)]));
        }
    }
    std::vector<PlacedSignature> signatures(partition.clips.size());
    for (SignatureShare& share : shares) {
        for (size_t i = 0; i < share.clips.size(); ++i) {
            signatures[static_cast<size_t>(share.clips[i])] = std::move(share.signatures[i]);
        }
    }
    return signatures;
}

std::vector<SignatureClip> clips_of(const PosePartition& partition) {
    std::vector<SignatureClip> clips;
    for (const PartitionClip& clip : partition.clips) {
        clips.push_back({clip.place.name, clip.place.pose_rows, clip.place.source_frames,
                         clip.place.source_rate});
    }
    return clips;
}

void tell(const StageContext& context, const PosePartition& partition,
          const SignatureIndex& index) {
    const auto runs = static_cast<int64_t>(index.parts().clips.values.size());
    context.log.info(
        "signatures {}: {} runs of {} leaves, {:.1f} frames a run", partition.path, runs,
        index.parts().near_leaves.size(),
        static_cast<double>(partition.rows()) / static_cast<double>(std::max<int64_t>(1, runs)));
}

}  // namespace

StageResult make_signatures(const StageContext& context, const StageTask& task) {
    const ArtifactReader models = context.workspace.open(*task.inputs_of("pose_hierarchy").front());
    std::vector<std::pair<PosePartition, ClassSignatures>> indexed;
    for (PosePartition& partition : class_partitions(context, task.inputs_of("features"))) {
        if (partition.rows() == 0) continue;
        const PoseHierarchy hierarchy = read_pose_hierarchy(models, partition.path).hierarchy;
        MatrixF axes = signature_axes(hierarchy);
        const auto signatures = signatures_of(context, partition, hierarchy, axes);
        if (!context.is_root()) continue;
        SignatureIndex index(signatures, positions_of(hierarchy.means, axes), {},
                             context.resources.threads);
        tell(context, partition, index);
        const double pose_rate = partition.feature_class().pose_rate;
        auto clips = clips_of(partition);
        indexed.emplace_back(
            std::move(partition),
            ClassSignatures{pose_rate, std::move(clips), std::move(axes), std::move(index)});
    }
    StageResult result;
    if (!context.is_root()) return result;
    ArtifactWriter file(task.output, task.header, context.writing());
    for (const auto& [partition, signatures] : indexed) {
        write_signatures(file, partition.path, signatures);
    }
    result.file = file.close();
    return result;
}

}  // namespace kinetome
