#include "kinetome/models/pose_clusters.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include "kinetome/base/piece_sum.h"

namespace kinetome {

namespace {

std::vector<int64_t> wanted_counts(const PoseClusterOptions& options, int64_t frames) {
    if (options.clusters != 0) return {options.clusters};
    switch (options.count_rule) {
        case ClusterCountRule::ratio: {
            if (!(options.frames_per_cluster > 0))
                throw std::invalid_argument("the frames per pose cluster must be positive");
            const double ratio = static_cast<double>(frames) / options.frames_per_cluster;
            const auto most = static_cast<double>(options.most_clusters);
            const auto least = static_cast<double>(options.least_clusters);
            return {static_cast<int64_t>(std::min(std::max(ratio, least), most))};
        }
        case ClusterCountRule::bic:
            return options.bic_clusters;
    }
    return {};
}

/// The fit just finished joins those tried; it becomes the best when its criterion is lower.
void enter(PoseClusters& best, MixtureFit fit, int64_t clusters, int64_t frames) {
    const double criterion = bayesian_information(fit, frames);
    const bool lowest = std::all_of(
        best.tried.begin(), best.tried.end(),
        [&](const TriedClusterCount& other) { return criterion < other.bayesian_information; });
    best.tried.push_back({clusters, criterion});
    if (lowest) best.fit = std::move(fit);
}

}  // namespace

std::vector<int64_t> cluster_counts(const PoseClusterOptions& options, int64_t frames) {
    std::vector<int64_t> counts;
    if (frames == 0) return counts;
    for (const int64_t wanted : wanted_counts(options, frames)) {
        if (wanted <= 0)
            throw std::invalid_argument("the number of pose clusters must be positive");
        const int64_t count = std::min(wanted, frames);
        if (std::find(counts.begin(), counts.end(), count) == counts.end()) counts.push_back(count);
    }
    if (counts.empty())
        throw std::invalid_argument(
            "choosing the number of pose clusters by BIC needs a list of numbers to try");
    return counts;
}

int64_t cluster_count(const PoseClusterOptions& options, int64_t frames) {
    const std::vector<int64_t> counts = cluster_counts(options, frames);
    return counts.empty() ? 0 : *std::max_element(counts.begin(), counts.end());
}

uint64_t fitting_bytes(int64_t rows, int64_t columns, int64_t pieces,
                       const PoseClusterOptions& options, int threads, int rank_count) {
    const auto sum_bytes =
        static_cast<uint64_t>(cluster_count(options, rows) * (columns + 2)) * sizeof(double);
    const int64_t runs = runs_per_rank(pieces, rank_count);
    const auto run_pieces = static_cast<uint64_t>(pieces / (runs * rank_count) + 1);
    const auto waiting =
        static_cast<uint64_t>(runs) * 2 * static_cast<uint64_t>(std::bit_width(run_pieces));
    const uint64_t on_their_way = rank_count > 1 ? 2 * waiting : 0;  // a message and what is in it
    const auto sums = 2 * static_cast<uint64_t>(threads) + waiting + on_their_way + 4;
    return start_bytes(rows, columns, options.mixture, rank_count) + sums * sum_bytes;
}

PoseClusters fit_pose_clusters(const RowSource& rows, const PoseClusterOptions& options,
                               const Workers& workers, const StopToken& stop,
                               const std::function<void(const PoseClusterProgress&)>& report,
                               const PoseClusterProgress* resume_from) {
    const std::vector<int64_t> counts = cluster_counts(options, rows.rows());
    if (counts.empty()) throw std::invalid_argument("pose clusters need at least one frame");

    PoseClusterProgress progress;
    if (resume_from) progress = *resume_from;
    const MixtureProgress* resume_mixture = resume_from ? &resume_from->mixture : nullptr;
    for (; progress.candidate < counts.size(); ++progress.candidate) {
        const int64_t clusters = counts[progress.candidate];
        MixtureFit fit = fit_mixture(
            rows, clusters, options.mixture, workers, stop,
            [&](const MixtureProgress& mixture) {
                if (!report) return;
                progress.mixture = mixture;
                report(progress);
            },
            std::exchange(resume_mixture, nullptr));
        enter(progress.best, std::move(fit), clusters, rows.rows());
    }
    return std::move(progress.best);
}

void pack(Packer& out, const PoseClusters& clusters) {
    pack(out, clusters.fit);
    out.put<uint64_t>(clusters.tried.size());
    for (const TriedClusterCount& tried : clusters.tried) {
        out.put(tried.clusters).put(tried.bayesian_information);
    }
}

void unpack(Unpacker& in, PoseClusters& clusters) {
    unpack(in, clusters.fit);
    clusters.tried.clear();
    for (auto left = in.get<uint64_t>(); left > 0; --left) {
        const auto count = in.get<int64_t>();
        clusters.tried.push_back({count, in.get<double>()});
    }
}

void pack(Packer& out, const PoseClusterProgress& progress) {
    out.put<uint64_t>(progress.candidate);
    pack(out, progress.mixture);
    pack(out, progress.best);
}

void unpack(Unpacker& in, PoseClusterProgress& progress) {
    progress.candidate = in.get<uint64_t>();
    unpack(in, progress.mixture);
    unpack(in, progress.best);
}

}  // namespace kinetome
