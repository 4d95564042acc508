// pose_clusters: moments → principal components → mixture of isotropic Gaussians, a partition
// after the other, with a checkpoint after every iteration of EM (S1 §3.2).
#include <fmt/format.h>

#include "kinetome/base/parallel.h"
#include "kinetome/run/checkpoint.h"
#include "kinetome/stages/pose_cluster_file.h"
#include "kinetome/stages/pose_rows.h"
#include "kinetome/stages/projection.h"
#include "kinetome/stages/stage.h"

namespace kinetome {
namespace {

void put(CheckpointWriter& out, const MatrixD& matrix) {
    out.put<int64_t>(matrix.rows());
    out.put(std::span<const double>(matrix.data(), static_cast<size_t>(matrix.size())));
}

MatrixD get_matrix(CheckpointReader& in) {
    const auto rows = in.get<int64_t>();
    const auto values = in.get_all<double>();
    const auto columns = rows ? static_cast<int64_t>(values.size()) / rows : 0;
    return Eigen::Map<const MatrixD>(values.data(), rows, columns);
}

void put(CheckpointWriter& out, const Mixture& mixture) {
    put(out, mixture.means);
    put(out, MatrixD(mixture.variances));
    put(out, MatrixD(mixture.weights));
}

Mixture get_mixture(CheckpointReader& in) {
    Mixture mixture;
    mixture.means = get_matrix(in);
    mixture.variances = get_matrix(in);
    mixture.weights = get_matrix(in);
    return mixture;
}

void put(CheckpointWriter& out, const MixtureFit& fit) {
    put(out, fit.model);
    out.put(fit.mean_log_likelihood);
    out.put(std::span<const double>(fit.history));
    out.put<uint8_t>(fit.converged);
}

MixtureFit get_fit(CheckpointReader& in) {
    MixtureFit fit;
    fit.model = get_mixture(in);
    fit.mean_log_likelihood = in.get<double>();
    fit.history = in.get_all<double>();
    fit.converged = in.get<uint8_t>();
    return fit;
}

void save(const PoseClusterProgress& progress, const std::filesystem::path& path) {
    CheckpointWriter out;
    out.put<uint64_t>(progress.candidate);
    const MixtureProgress& mixture = progress.mixture;
    out.put<int32_t>(mixture.restart).put<int32_t>(mixture.iteration);
    out.put(mixture.mean_log_likelihood).put(std::span<const double>(mixture.history));
    out.put<uint8_t>(mixture.converged);
    put(out, mixture.model);
    put(out, mixture.best);
    put(out, progress.best.fit);
    out.put<uint64_t>(progress.best.tried.size());
    for (const TriedClusterCount& tried : progress.best.tried) {
        out.put(tried.clusters).put(tried.bayesian_information);
    }
    out.save(path);
}

/// Nothing when there is none, or when another version of this program made it.
std::optional<PoseClusterProgress> load(const std::filesystem::path& path) try {
    auto in = CheckpointReader::open(path);
    if (!in) return std::nullopt;
    PoseClusterProgress progress;
    progress.candidate = in->get<uint64_t>();
    MixtureProgress& mixture = progress.mixture;
    mixture.restart = in->get<int32_t>();
    mixture.iteration = in->get<int32_t>();
    mixture.mean_log_likelihood = in->get<double>();
    mixture.history = in->get_all<double>();
    mixture.converged = in->get<uint8_t>();
    mixture.model = get_mixture(*in);
    mixture.best = get_fit(*in);
    progress.best.fit = get_fit(*in);
    const auto tried = in->get<uint64_t>();
    for (uint64_t i = 0; i < tried; ++i) {
        TriedClusterCount one;
        one.clusters = in->get<int64_t>();
        one.bayesian_information = in->get<double>();
        progress.best.tried.push_back(one);
    }
    return progress;
} catch (const StoreError&) {
    return std::nullopt;
}

Pca principal_components(const StageContext& context, const PosePartition& partition) {
    const auto moments = sum_pieces<Moments>(
        context.resources.threads, partition.layout,
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

PoseClusterOptions resolved(PoseClusterOptions options) {
    if (options.clusters > 0) options.count_rule = ClusterCountRule::given;
    return options;
}

PoseClusters cluster(const StageContext& context, const PosePartition& partition,
                     const MatrixF& rows, const std::filesystem::path& checkpoint) {
    const auto earlier = load(checkpoint);
    if (earlier) {
        context.log.info("pose_clusters {}: goes on after iteration {}", partition.path,
                         earlier->mixture.iteration);
    }
    return fit_pose_clusters(
        rows, partition.layout, resolved(context.options.pose_clusters), context.resources.threads,
        context.stop, [&](const PoseClusterProgress& progress) { save(progress, checkpoint); },
        earlier ? &*earlier : nullptr);
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
    ArtifactWriter file(task.output, task.header,
                        parse_compression(context.options.frames.compression));
    StageResult result;
    const auto partitions = pose_partitions(context, task.inputs_of("features"));
    for (size_t i = 0; i < partitions.size(); ++i) {
        const PosePartition& partition = partitions[i];
        if (partition.rows() < 2) {
            skip(partition, result);
            continue;
        }
        const Pca pca = principal_components(context, partition);
        const MatrixF rows = project_rows(partition, pca, context.resources.threads, context.stop);
        const auto checkpoint =
            context.workspace.folder() / fmt::format("checkpoint-{}-{}", task.header.key.hex(), i);
        const PoseClusters clusters = cluster(context, partition, rows, checkpoint);
        write_pose_clusters(file, partition.path, pca, clusters);
        context.log.info(
            "pose_clusters {}: {} frames, {} components ({:.1f} % of variance), {} clusters, "
            "mean log-likelihood {:.4f} after {} iterations",
            partition.path, partition.rows(), pca.dimension(), 100 * pca.kept_share(),
            clusters.clusters(), clusters.fit.mean_log_likelihood, clusters.fit.history.size());
    }
    result.file = file.close();
    return result;
}

}  // namespace kinetome
