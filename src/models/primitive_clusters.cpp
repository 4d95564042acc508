#include "kinetome/models/primitive_clusters.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "disjoint_sets.h"
#include "kinetome/base/parallel.h"
#include "kinetome/math/knn.h"
#include "kinetome/math/warp.h"
#include "primitive_rows.h"

namespace kinetome {
namespace {

using Members = std::vector<std::vector<int32_t>>;

/// Numbered from 0 by their lowest elements.
std::vector<int32_t> numbered(DisjointSets& sets, int64_t elements) {
    std::vector<int32_t> numbers(static_cast<size_t>(elements), -1), result;
    int32_t count = 0;
    for (int32_t i = 0; i < elements; ++i) {
        int32_t& number = numbers[static_cast<size_t>(sets.root(i))];
        if (number < 0) number = count++;
        result.push_back(number);
    }
    return result;
}

Members members_of(std::span<const int32_t> clusters) {
    Members members;
    for (size_t i = 0; i < clusters.size(); ++i) {
        const auto cluster = static_cast<size_t>(clusters[i]);
        if (cluster == members.size()) members.emplace_back();
        members[cluster].push_back(static_cast<int32_t>(i));
    }
    return members;
}

/// Which primitives a path may join, and which it does.
class Comparison {
  public:
    Comparison(const MatrixFView& features, std::span<const CorpusPrimitive> primitives,
               const PrimitiveClusterOptions& options)
        : features_(features), primitives_(primitives), options_(options) {
        warping_.end_slip = 1;
        warping_.radius = options.radius;
    }

    bool joined(int32_t a, int32_t b) const {
        return warp_cost(rows(a), rows(b), warping_, options_.threshold) <= options_.threshold;
    }

    /// The first two frames of each primitive: a path begins at the first of either.
    MatrixF starts(std::span<const int32_t> primitives) const {
        MatrixF starts(2 * static_cast<int64_t>(primitives.size()), features_.cols());
        for (size_t i = 0; i < primitives.size(); ++i) {
            const RowRange& range = primitives_[static_cast<size_t>(primitives[i])].rows;
            const auto row = 2 * static_cast<int64_t>(i);
            starts.row(row) = features_.row(range.first);
            starts.row(row + 1) = features_.row(std::min(range.first + 1, range.end - 1));
        }
        return starts;
    }

  private:
    MatrixFView rows(int32_t primitive) const {
        return rows_of(features_, primitives_[static_cast<size_t>(primitive)]);
    }

    const MatrixFView features_;
    std::span<const CorpusPrimitive> primitives_;
    const PrimitiveClusterOptions options_;
    WarpOptions warping_;
};

/// The components of each clip by itself.
std::vector<int32_t> clusters_of_clips(std::span<const CorpusPrimitive> primitives,
                                       const Comparison& comparison, int threads) {
    const auto count = static_cast<int64_t>(primitives.size());
    std::vector<int64_t> firsts;
    for (int64_t i = 0; i < count; ++i) {
        if (i == 0 || primitives[size_t(i)].clip != primitives[size_t(i) - 1].clip)
            firsts.push_back(i);
    }
    firsts.push_back(count);
    DisjointSets sets(count);
    parallel_for(threads, static_cast<int64_t>(firsts.size()) - 1, [&](int64_t clip) {
        const auto first = static_cast<int32_t>(firsts[static_cast<size_t>(clip)]);
        const auto end = static_cast<int32_t>(firsts[static_cast<size_t>(clip) + 1]);
        for (int32_t b = first; b < end; ++b) {
            for (int32_t a = first; a < b; ++a) {
                if (!sets.together(a, b) && comparison.joined(a, b)) sets.unite(a, b);
            }
        }
    });
    return numbered(sets, count);
}

/// Primitives of two clusters between which there may be a path.
struct Candidate {
    int32_t cluster = 0;  ///< of b
    int32_t a = 0, b = 0;
    auto operator<=>(const Candidate&) const = default;
};

/// Finds which clusters of the clips are one.
class ClusterJoiner {
  public:
    ClusterJoiner(std::span<const CorpusPrimitive> primitives, std::span<const int32_t> clusters,
                  const Comparison& comparison, const PrimitiveClusterOptions& options, int threads)
        : primitives_(primitives),
          clusters_(clusters),
          members_(members_of(clusters)),
          comparison_(comparison),
          options_(options),
          index_(starts_of_all(), KnnEngine::blocks, threads),
          sets_(static_cast<int64_t>(members_.size())) {}

    /// The number of the joined cluster for each of the clips' clusters.
    std::vector<int32_t> join(int threads) {
        const auto count = static_cast<int64_t>(members_.size());
        parallel_for(threads, count,
                     [&](int64_t cluster) { join_to_earlier(static_cast<int32_t>(cluster)); });
        return numbered(sets_, count);
    }

  private:
    MatrixF starts_of_all() const {
        std::vector<int32_t> all(primitives_.size());
        for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int32_t>(i);
        return comparison_.starts(all);
    }

    const std::vector<int32_t>& members(int32_t cluster) const {
        return members_[static_cast<size_t>(cluster)];
    }
    int64_t clip(int32_t primitive) const { return primitives_[size_t(primitive)].clip; }

    /// In the order of the clusters they belong to.
    std::vector<Candidate> candidates(int32_t cluster) const {
        const MatrixF starts = comparison_.starts(members(cluster));
        const NeighbourLists lists = index_.search(starts, {options_.radius, index_.rows()}, 1);
        std::vector<Candidate> candidates;
        for (int64_t query = 0; query < lists.queries(); ++query) {
            const int32_t a = members(cluster)[static_cast<size_t>(query / 2)];
            for (const int32_t row : lists.rows_of(query)) {
                const int32_t b = row / 2, other = clusters_[static_cast<size_t>(b)];
                if (other < cluster && clip(a) != clip(b)) candidates.push_back({other, a, b});
            }
        }
        std::ranges::sort(candidates);
        const auto repeated = std::ranges::unique(candidates);
        candidates.erase(repeated.begin(), repeated.end());
        return candidates;
    }

    void join_to_earlier(int32_t cluster) {
        const std::vector<Candidate> all = candidates(cluster);
        for (auto first = all.begin(); first != all.end();) {
            const int32_t other = first->cluster;
            const auto end = std::find_if(first, all.end(),
                                          [&](const Candidate& c) { return c.cluster != other; });
            const auto pairs = double(members(cluster).size() * members(other).size());
            const auto needed = std::max<int64_t>(
                1, static_cast<int64_t>(std::ceil(options_.share_across * pairs)));
            if (!sets_.together(cluster, other) && enough({first, end}, needed)) {
                sets_.unite(cluster, other);
            }
            first = end;
        }
    }

    /// Whether so many of the candidates are joined.
    bool enough(std::span<const Candidate> candidates, int64_t needed) const {
        auto left = static_cast<int64_t>(candidates.size());
        for (const Candidate& candidate : candidates) {
            if (needed == 0 || left < needed) break;
            if (comparison_.joined(candidate.a, candidate.b)) --needed;
            --left;
        }
        return needed == 0;
    }

    std::span<const CorpusPrimitive> primitives_;
    std::span<const int32_t> clusters_;
    const Members members_;
    const Comparison& comparison_;
    const PrimitiveClusterOptions& options_;
    const KnnIndex index_;
    DisjointSets sets_;
};

}  // namespace

std::vector<int32_t> cluster_primitives(const MatrixFView& features,
                                        std::span<const CorpusPrimitive> primitives,
                                        const PrimitiveClusterOptions& options, int threads) {
    if (!(options.threshold >= 0 && options.radius >= 0 && options.share_across >= 0 &&
          options.share_across <= 1)) {
        throw std::invalid_argument("clusters take a threshold, a radius and a share of 0 or more");
    }
    require_rows(features, primitives);
    if (primitives.empty()) return {};
    const Comparison comparison(features, primitives, options);
    std::vector<int32_t> clusters = clusters_of_clips(primitives, comparison, threads);
    const std::vector<int32_t> joined =
        ClusterJoiner(primitives, clusters, comparison, options, threads).join(threads);
    for (int32_t& cluster : clusters) cluster = joined[static_cast<size_t>(cluster)];
    return clusters;
}

}  // namespace kinetome
