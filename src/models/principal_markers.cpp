#include "kinetome/models/principal_markers.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>

#include "kinetome/math/kmeans.h"
#include "kinetome/math/symmetric_eigen.h"
#include "kinetome/models/pose_hierarchy.h"

namespace kinetome {
namespace {

constexpr double mm_per_cm = 10;

void check(const Moments& poses) {
    if (poses.dimension() % 3 != 0) {
        throw std::invalid_argument(
            fmt::format("{} columns are not markers of three coordinates", poses.dimension()));
    }
    for (int64_t j = 0; j < poses.dimension(); ++j) {
        if (std::isfinite(poses.mean[j]) && std::isfinite(poses.scatter(j, j))) continue;
        throw std::invalid_argument(fmt::format(
            "coordinate {} of marker {} is not finite in every pose", "xyz"[j % 3], j / 3));
    }
}

/// The coordinates that move, with their covariance.
struct MovingColumns {
    std::vector<int32_t> columns;
    MatrixD covariance;  ///< cm²
};

MovingColumns moving_columns(const Moments& poses, double least_deviation) {
    const MatrixD covariance =
        poses.scatter / static_cast<double>(std::max<int64_t>(poses.count, 1));
    MovingColumns moving;
    for (int64_t j = 0; j < poses.dimension(); ++j) {
        if (mm_per_cm * std::sqrt(covariance(j, j)) >= least_deviation) {
            moving.columns.push_back(static_cast<int32_t>(j));
        }
    }
    moving.covariance = covariance(moving.columns, moving.columns);
    return moving;
}

/// Leading eigenvectors, one a column, with their variances.
struct Components {
    MatrixD loadings;
    VectorD variances;
};

/// The fewest, at least one, that leave no more than the tolerance unexplained.
Components leading_components(const MatrixD& covariance, int64_t markers, double tolerance) {
    const SymmetricEigen eigen = symmetric_eigen(covariance);
    const VectorD variances = eigen.values.cwiseMax(0.0);
    const double allowed = std::pow(tolerance / mm_per_cm, 2) * static_cast<double>(markers);
    double left = 0;
    int64_t kept = variances.size();
    while (kept > 1 && left + variances[kept - 1] <= allowed) left += variances[--kept];
    return {eigen.vectors.leftCols(kept), variances.head(kept)};
}

/// What a marker brings to the cover: the clusters its coordinates are in, and how much of each
/// one's variance they hold.
struct Candidate {
    int32_t marker = 0;
    std::set<int32_t> clusters;
    double importance = 0;  ///< largest share of a cluster's explained variance
};

std::vector<Candidate> candidates(const MovingColumns& moving, const Components& components,
                                  const std::vector<int32_t>& cluster_of) {
    const VectorD explained =
        components.loadings.cwiseAbs2() * components.variances;  // of each coordinate
    std::vector<double> of_cluster(moving.columns.size() + 1, 0.0);
    for (size_t i = 0; i < cluster_of.size(); ++i) {
        of_cluster[static_cast<size_t>(cluster_of[i])] += explained[static_cast<Eigen::Index>(i)];
    }
    std::vector<Candidate> found;
    std::vector<double> share(of_cluster.size());
    for (size_t i = 0; i < moving.columns.size(); ++i) {
        const int32_t marker = moving.columns[i] / 3;
        if (found.empty() || found.back().marker != marker) {
            found.push_back({marker, {}, 0});
            std::ranges::fill(share, 0.0);
        }
        Candidate& candidate = found.back();
        const auto cluster = static_cast<size_t>(cluster_of[i]);
        candidate.clusters.insert(cluster_of[i]);
        share[cluster] += explained[static_cast<Eigen::Index>(i)];
        if (of_cluster[cluster] > 0) {
            candidate.importance =
                std::max(candidate.importance, share[cluster] / of_cluster[cluster]);
        }
    }
    return found;
}

int64_t count_new(const std::set<int32_t>& covered, const Candidate& candidate) {
    return std::ranges::count_if(candidate.clusters,
                                 [&](int32_t cluster) { return !covered.contains(cluster); });
}

/// Those without which some cluster is not covered, the least important tried first.
void drop_redundant(std::vector<Candidate>& chosen) {
    std::ranges::stable_sort(chosen, {}, &Candidate::importance);
    for (size_t i = 0; i < chosen.size();) {
        std::set<int32_t> covered;
        for (size_t other = 0; other < chosen.size(); ++other) {
            if (other != i)
                covered.insert(chosen[other].clusters.begin(), chosen[other].clusters.end());
        }
        if (count_new(covered, chosen[i]) == 0) {
            chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(i));
        } else {
            ++i;
        }
    }
}

std::vector<int32_t> minimal_cover(const std::vector<Candidate>& all) {
    std::vector<Candidate> chosen;
    for (std::set<int32_t> covered;;) {
        const auto best =
            std::ranges::max_element(all, [&](const Candidate& a, const Candidate& b) {
                const int64_t new_a = count_new(covered, a), new_b = count_new(covered, b);
                return new_a != new_b ? new_a < new_b : a.importance < b.importance;
            });
        if (best == all.end() || count_new(covered, *best) == 0) break;
        chosen.push_back(*best);
        covered.insert(best->clusters.begin(), best->clusters.end());
    }
    drop_redundant(chosen);
    std::vector<int32_t> markers;
    for (const Candidate& candidate : chosen) markers.push_back(candidate.marker);
    std::ranges::sort(markers);
    return markers;
}

/// RMS that a linear estimate of all coordinates from those of the markers leaves, mm per marker.
double linear_residual(const MovingColumns& moving, const std::vector<int32_t>& markers,
                       int64_t compared) {
    std::vector<Eigen::Index> known, other;
    for (size_t i = 0; i < moving.columns.size(); ++i) {
        const bool chosen = std::ranges::binary_search(markers, moving.columns[i] / 3);
        (chosen ? known : other).push_back(static_cast<Eigen::Index>(i));
    }
    // Noise of a millimetre on what is known keeps coordinates that move together from being told
    // apart by rounding.
    const double noise = 1 / (mm_per_cm * mm_per_cm);
    MatrixD of_known = moving.covariance(known, known);
    of_known.diagonal().array() += noise;
    const MatrixD between = moving.covariance(known, other);
    const MatrixD explained = between.transpose() * of_known.ldlt().solve(between);
    double left = 0;
    for (size_t i = 0; i < other.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        left += std::max(moving.covariance(other[i], other[i]) - explained(at, at), 0.0);
    }
    return mm_per_cm * std::sqrt(left / static_cast<double>(compared));
}

std::vector<int32_t> columns_of(const MovingColumns& moving, const std::vector<int32_t>& markers) {
    std::vector<int32_t> columns;
    for (const int32_t column : moving.columns) {
        if (std::ranges::binary_search(markers, column / 3)) columns.push_back(column);
    }
    return columns;
}

}  // namespace

PrincipalMarkers select_principal_markers(const Moments& poses,
                                          const PrincipalMarkerOptions& options) {
    check(poses);
    const MovingColumns moving = moving_columns(poses, options.least_deviation);
    if (moving.columns.empty()) return {};
    const int64_t compared = compared_markers(poses.dimension());
    const Components components =
        leading_components(moving.covariance, compared, options.tolerance);
    const MatrixD loadings = components.loadings.cwiseAbs();

    std::optional<PrincipalMarkers> best;
    for (int start = 0; start < options.starts; ++start) {
        const KMeansOptions clustering{.clusters = loadings.cols() + options.extra_clusters,
                                       .restarts = 1,
                                       .seed = options.seed + static_cast<uint64_t>(start)};
        const std::vector<int32_t> markers =
            minimal_cover(candidates(moving, components, kmeans(loadings, clustering)));
        const double residual = linear_residual(moving, markers, compared);
        if (best && residual >= best->residual) continue;
        best = {markers, columns_of(moving, markers), loadings.cols(), start, residual};
    }
    return *best;
}

void pack(Packer& out, const PrincipalMarkers& principal) {
    pack(out, principal.markers);
    pack(out, principal.columns);
    out.put(principal.components).put(principal.start).put(principal.residual);
}

void unpack(Unpacker& in, PrincipalMarkers& principal) {
    unpack(in, principal.markers);
    unpack(in, principal.columns);
    unpack(in, principal.components);
    unpack(in, principal.start);
    unpack(in, principal.residual);
}

}  // namespace kinetome
