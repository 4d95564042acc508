// pose_hierarchy: principal markers and the piecewise-linear model of each class (S2 §3, §4), with
// a checkpoint after every level.
#include <fmt/format.h>

#include <algorithm>

#include "kinetome/base/pack_fields.h"
#include "kinetome/base/piece_sum.h"
#include "kinetome/math/kept_rows.h"
#include "kinetome/run/checkpoint.h"
#include "kinetome/stages/pose_hierarchy_file.h"
#include "kinetome/stages/pose_hierarchy_memory.h"
#include "kinetome/stages/pose_rows.h"
#include "kinetome/stages/stage.h"
#include "kinetome/stages/work_share.h"

namespace kinetome {
namespace {

struct GrownClass {
    PrincipalMarkers principal;
    GrownHierarchy grown;
};

void pack(Packer& out, const GrownClass& one) {
    pack_all(out, one.principal, one.grown);
}

void unpack(Unpacker& in, GrownClass& one) {
    unpack_all(in, one.principal, one.grown);
}

Moments marker_moments(const StageContext& context, const PosePartition& partition,
                       const Workers& workers) {
    const auto moments = sum_pieces<Moments>(
        workers, partition.layout,
        [&](const RowRange& piece) {
            context.stop.check();
            return moments_of(partition.read_markers(piece));
        },
        [](Moments& left, const Moments& right) { merge(left, right); });
    return *moments;
}

/// What rank 0 keeps of each level, at every rank when it is asked for.
GrowthCheckpoints checkpoints(const StageContext& context, const std::string& path,
                              const Workers& workers) {
    const auto file = [path](int level) { return fmt::format("{}-{}", path, level); };
    GrowthCheckpoints kept;
    kept.save = [&context, workers, file](int level, const HierarchyLevel& grown) {
        if (workers.is_root()) save_checkpoint(file(level), packed(grown));
        context.check_ranks();
    };
    kept.load = [workers, file](int level) -> std::optional<HierarchyLevel> {
        std::string bytes;
        if (workers.is_root()) bytes = load_checkpoint(file(level)).value_or("");
        if (workers.rank_count() > 1) bytes = workers.ranks->broadcast(std::move(bytes));
        if (bytes.empty()) return std::nullopt;
        try {
            return unpacked<HierarchyLevel>(std::move(bytes));
        } catch (const std::out_of_range&) {  // another version of this program made it
            return std::nullopt;
        }
    };
    return kept;
}

void tell(const StageContext& context, const PosePartition& partition, const GrownClass& one) {
    const auto names = partition.feature_class().marker_names;
    std::vector<std::string> principal;
    for (const int32_t marker : one.principal.markers) {
        principal.push_back(names[static_cast<size_t>(marker)]);
    }
    const PoseHierarchy& hierarchy = one.grown.hierarchy;
    context.log.info(
        "pose_hierarchy {}: {} principal markers ({}), linear residual {:.1f} mm; {} leaves of "
        "dimension {}, {:.1f} frames a leaf",
        partition.path, principal.size(), fmt::join(principal, " "), one.principal.residual,
        hierarchy.leaves(), hierarchy.dimension(),
        static_cast<double>(partition.rows()) / static_cast<double>(hierarchy.leaves()));
}

GrownClass grow(const StageContext& context, const PosePartition& partition,
                const std::string& checkpoint, const Workers& workers) {
    if (partition.rows() == 0) return {};
    const PoseHierarchyOptions& options = context.options.pose_hierarchy;
    GrownClass result;
    const Moments moments = marker_moments(context, partition, workers);
    result.principal = select_principal_markers(moments, context.options.principal_markers);
    const std::vector<int32_t>& columns = result.principal.columns;

    const HierarchyMemory memory =
        share_memory({partition.rows(), moments.dimension(), static_cast<int64_t>(columns.size())},
                     options, context.resources, workers.rank_count());
    const StopToken& stop = context.stop;
    const KeptRows poses(
        partition.layout, moments.dimension(),
        [&](const RowRange& range) {
            stop.check();
            return partition.read_markers(range);
        },
        workers, memory.pose_bytes);
    const KeptRows principal(
        partition.layout, static_cast<int64_t>(columns.size()),
        [&](const RowRange& range) -> MatrixF {
            return poses.read(range).view()(Eigen::all, columns);
        },
        workers, memory.principal_bytes);
    result.grown =
        grow_pose_hierarchy(poses, principal, columns, options, workers, memory.nodes_per_pass,
                            stop, checkpoints(context, checkpoint, workers));
    if (workers.is_root()) tell(context, partition, result);
    return result;
}

}  // namespace

StageResult make_pose_hierarchy(const StageContext& context, const StageTask& task) {
    const auto partitions = class_partitions(context, task.inputs_of("features"));
    auto grown = for_partitions<GrownClass>(
        context.workers(), partitions, [&](size_t i, const Workers& workers) {
            const auto checkpoint = context.workspace.folder() /
                                    fmt::format("checkpoint-{}-{}", task.header.key.hex(), i);
            return grow(context, partitions[i], checkpoint.string(), workers);
        });
    StageResult result;
    if (!context.is_root()) return result;
    ArtifactWriter file(task.output, task.header, context.writing());
    for (size_t i = 0; i < partitions.size(); ++i) {
        if (partitions[i].rows() == 0) continue;
        const FeatureClass shared = partitions[i].feature_class();
        write_pose_hierarchy(
            file, partitions[i].path,
            {std::move(grown[i].principal), std::move(grown[i].grown.hierarchy),
             std::move(grown[i].grown.maps), shared.marker_names, shared.pose_rate});
    }
    result.file = file.close();
    return result;
}

}  // namespace kinetome
