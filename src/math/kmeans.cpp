#include "kinetome/math/kmeans.h"

#include <limits>
#include <stdexcept>

#include "kinetome/base/random.h"

namespace kinetome {
namespace {

struct Assignment {
    std::vector<int32_t> clusters;
    double squared = std::numeric_limits<double>::infinity();  ///< Σ squared distances
};

/// Rows drawn by their squared distance to the nearest drawn before; fewer than asked for when all
/// others coincide with those.
MatrixD drawn_centroids(const MatrixDView& rows, int64_t clusters, RandomStream random) {
    std::vector<int64_t> drawn{
        static_cast<int64_t>(random.below(static_cast<uint64_t>(rows.rows())))};
    VectorD nearest = (rows.rowwise() - rows.row(drawn[0])).rowwise().squaredNorm();
    while (static_cast<int64_t>(drawn.size()) < clusters) {
        const double total = nearest.sum();
        if (!(total > 0)) break;
        double left = random.uniform() * total;
        int64_t row = 0;
        while (row + 1 < rows.rows() && (left -= nearest[row]) >= 0) ++row;
        while (!(nearest[row] > 0)) --row;  // rounding led beyond the last that can be drawn
        drawn.push_back(row);
        nearest = nearest.cwiseMin((rows.rowwise() - rows.row(row)).rowwise().squaredNorm());
    }
    MatrixD centroids(static_cast<Eigen::Index>(drawn.size()), rows.cols());
    for (size_t c = 0; c < drawn.size(); ++c) {
        centroids.row(static_cast<Eigen::Index>(c)) = rows.row(drawn[c]);
    }
    return centroids;
}

Assignment assign(const MatrixDView& rows, const MatrixD& centroids) {
    Assignment result;
    result.squared = 0;
    for (int64_t i = 0; i < rows.rows(); ++i) {
        Eigen::Index nearest = 0;
        result.squared +=
            (centroids.rowwise() - rows.row(i)).rowwise().squaredNorm().minCoeff(&nearest);
        result.clusters.push_back(static_cast<int32_t>(nearest));
    }
    return result;
}

/// Means of the clusters; one without rows stays where it is.
void move_to_means(const MatrixDView& rows, const std::vector<int32_t>& clusters,
                   MatrixD& centroids) {
    MatrixD sums = MatrixD::Zero(centroids.rows(), centroids.cols());
    VectorD counts = VectorD::Zero(centroids.rows());
    for (int64_t i = 0; i < rows.rows(); ++i) {
        sums.row(clusters[static_cast<size_t>(i)]) += rows.row(i);
        counts[clusters[static_cast<size_t>(i)]] += 1;
    }
    for (int64_t c = 0; c < centroids.rows(); ++c) {
        if (counts[c] > 0) centroids.row(c) = sums.row(c) / counts[c];
    }
}

}  // namespace

std::vector<int32_t> kmeans(const MatrixDView& rows, const KMeansOptions& options) {
    if (options.clusters < 1 || options.restarts < 1) {
        throw std::invalid_argument("k-means needs at least one cluster and one start");
    }
    if (rows.rows() == 0) return {};
    Assignment best;
    for (int start = 0; start < options.restarts; ++start) {
        MatrixD centroids =
            drawn_centroids(rows, options.clusters,
                            RandomStream(options.seed, "kmeans", static_cast<uint64_t>(start)));
        Assignment now = assign(rows, centroids);
        for (int i = 0; i < options.max_iterations; ++i) {
            move_to_means(rows, now.clusters, centroids);
            Assignment next = assign(rows, centroids);
            const bool settled = next.clusters == now.clusters;
            now = std::move(next);
            if (settled) break;
        }
        if (now.squared < best.squared) best = std::move(now);
    }
    return best.clusters;
}

}  // namespace kinetome
