// pose_clusters: moments → principal components → mixture of isotropic Gaussians, by partition,
// with a checkpoint after every iteration of EM (S1 §3.2).
#include <fmt/format.h>

#include "kinetome/base/pack_fields.h"
#include "kinetome/base/piece_sum.h"
#include "kinetome/run/checkpoint.h"
#include "kinetome/stages/pose_cluster_file.h"
#include "kinetome/stages/pose_rows.h"
#include "kinetome/stages/projected_rows.h"
#include "kinetome/stages/stage.h"
#include "kinetome/stages/work_share.h"

namespace kinetome {
namespace {

/// What is known of a partition in the end; nothing was fitted where there are fewer than two rows.
struct FittedPartition {
    Pca pca;
    PoseClusters clusters;

    bool is_fitted() const { return clusters.clusters() > 0; }
};

void pack(Packer& out, const FittedPartition& fitted) {
    pack_all(out, fitted.pca, fitted.clusters);
}

void unpack(Unpacker& in, FittedPartition& fitted) {
    unpack_all(in, fitted.pca, fitted.clusters);
}

Pca principal_components(const StageContext& context, const PosePartition& partition,
                         const Workers& workers) {
    const auto moments = sum_pieces<Moments>(
        workers, partition.layout,
        [&](const RowRange& piece) {
            context.stop.check();
            return moments_of(partition.read(piece));
        },
        [](Moments& left, const Moments& right) { merge(left, right); });
    const std::vector<double> floors = partition.feature_class().pose_vector_floors;
    return fit_pca(
        *moments,
        Eigen::Map<const VectorD>(floors.data(), static_cast<Eigen::Index>(floors.size())),
        context.options.pose_clusters.variance_share);
}

/// What rank 0 finds of an earlier run, at every rank.
std::optional<PoseClusterProgress> earlier_progress(const std::filesystem::path& checkpoint,
                                                    const Workers& workers) {
    std::string bytes;
    if (workers.is_root()) bytes = load_checkpoint(checkpoint).value_or("");
    if (workers.rank_count() > 1) bytes = workers.ranks->broadcast(std::move(bytes));
    if (bytes.empty()) return std::nullopt;
    try {
        return unpacked<PoseClusterProgress>(std::move(bytes));
    } catch (const std::out_of_range&) {  // another version of this program made it
        return std::nullopt;
    }
}

/// Of the memory granted, what is left for keeping rows.
uint64_t bytes_for_rows(const StageContext& context, const PosePartition& partition,
                        int64_t columns, const PoseClusterOptions& options,
                        const Workers& workers) {
    // For readers, logs, and what the heap does not give back.
    constexpr uint64_t reserve = 32 << 20;
    const uint64_t granted = context.resources.memory_bytes;
    const uint64_t needed = resident_bytes() + reserve +
                            fitting_bytes(partition.rows(), columns,
                                          static_cast<int64_t>(partition.layout.pieces.size()),
                                          options, workers.threads, workers.rank_count());
    if (needed > granted) {
        throw UsageError(fmt::format(
            "pose_clusters {}: needs {} of memory at each rank, but {} are granted ({}): raise "
            "--memory, lower --start-sample, or use more ranks",
            partition.path, describe_bytes(needed), describe_bytes(granted),
            context.resources.memory_source));
    }
    return granted - needed;
}

FittedPartition fit(const StageContext& context, const PosePartition& partition,
                    const std::filesystem::path& checkpoint, const Workers& workers) {
    if (partition.rows() < 2) return {};
    const PoseClusterOptions& options = context.options.pose_clusters;
    FittedPartition fitted;
    fitted.pca = principal_components(context, partition, workers);
    const KeptRows rows = projected_rows(
        partition, fitted.pca, workers,
        bytes_for_rows(context, partition, fitted.pca.dimension(), options, workers), context.stop);
    const auto earlier = earlier_progress(checkpoint, workers);
    if (earlier) {
        context.log.info("pose_clusters {}: goes on after iteration {}", partition.path,
                         earlier->mixture.iteration);
    }
    fitted.clusters = fit_pose_clusters(
        rows, options, workers, context.stop,
        [&](const PoseClusterProgress& progress) {
            if (workers.is_root()) save_checkpoint(checkpoint, packed(progress));
            context.check_ranks();
        },
        earlier ? &*earlier : nullptr);
    context.log.info(
        "pose_clusters {}: {} frames, {} components ({:.1f} % of variance), {} clusters, "
        "mean log-likelihood {:.4f} after {} iterations",
        partition.path, partition.rows(), fitted.pca.dimension(), 100 * fitted.pca.kept_share(),
        fitted.clusters.clusters(), fitted.clusters.fit.mean_log_likelihood,
        fitted.clusters.fit.history.size());
    return fitted;
}

void skip(const PosePartition& partition, StageResult& result) {
    for (const PartitionClip& clip : partition.clips) {
        result.clips.push_back({.clip = clip.place.name,
                                .skipped = fmt::format("{} has {} frame(s): no variance to cluster",
                                                       partition.path, partition.rows())});
    }
}

}  // namespace

StageResult make_pose_clusters(const StageContext& context, const StageTask& task) {
    const auto partitions = pose_partitions(context, task.inputs_of("features"));
    const auto fitted = for_partitions<FittedPartition>(
        context.workers(), partitions, [&](size_t i, const Workers& workers) {
            const auto checkpoint = context.workspace.folder() /
                                    fmt::format("checkpoint-{}-{}", task.header.key.hex(), i);
            return fit(context, partitions[i], checkpoint, workers);
        });
    StageResult result;
    if (!context.is_root()) return result;
    ArtifactWriter file(task.output, task.header, context.writing());
    for (size_t i = 0; i < partitions.size(); ++i) {
        if (fitted[i].is_fitted()) {
            write_pose_clusters(file, partitions[i].path, fitted[i].pca, fitted[i].clusters);
        } else {
            skip(partitions[i], result);
        }
    }
    result.file = file.close();
    return result;
}

}  // namespace kinetome
