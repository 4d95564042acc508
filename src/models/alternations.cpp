// Alternating clusters joined (join_alternations of primitive_clusters.h).
#include <algorithm>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "kinetome/models/primitive_clusters.h"

namespace kinetome {
namespace {

struct Pair {
    int32_t first = 0, second = 0;
    auto operator<=>(const Pair&) const = default;
};

struct PairCount {
    int64_t occurrences = 0;
    int64_t repeats = 0;  ///< most in one chain of primitives that adjoin
    int64_t chain = -1, in_chain = 0;

    void occur_in(int64_t in) {
        in_chain = chain == in ? in_chain + 1 : 1;
        chain = in;
        ++occurrences;
        repeats = std::max(repeats, in_chain);
    }
};

/// What follows what, where primitives adjoin.
struct Successions {
    std::map<Pair, PairCount> pairs;
    std::map<int32_t, int64_t> followed, preceded;  ///< how many primitives of a cluster are

    explicit Successions(const PrimitiveClusters& clusters) {
        int64_t chain = 0;
        for (size_t i = 0; i + 1 < clusters.primitives.size(); ++i) {
            if (!adjoin(clusters.primitives[i], clusters.primitives[i + 1])) {
                ++chain;
                continue;
            }
            const Pair pair{clusters.clusters[i], clusters.clusters[i + 1]};
            pairs[pair].occur_in(chain);
            ++followed[pair.first];
            ++preceded[pair.second];
        }
    }
};

/// The pairs to join, no cluster in two of them: the second of each by its first.
std::map<int32_t, int32_t> pairs_to_join(const PrimitiveClusters& clusters,
                                         const AlternationOptions& options) {
    const Successions successions(clusters);
    std::vector<std::pair<int64_t, Pair>> candidates;
    for (const auto& [pair, count] : successions.pairs) {
        const int64_t sides =
            std::max(successions.followed.at(pair.first), successions.preceded.at(pair.second));
        if (pair.first != pair.second && count.repeats >= options.least_repeats &&
            double(count.occurrences) >= options.share * double(sides)) {
            candidates.emplace_back(-count.occurrences, pair);
        }
    }
    std::ranges::sort(candidates);
    std::map<int32_t, int32_t> second_of;
    std::map<int32_t, bool> taken;
    for (const auto& [order, pair] : candidates) {
        if (taken[pair.first] || taken[pair.second]) continue;
        taken[pair.first] = taken[pair.second] = true;
        second_of[pair.first] = pair.second;
    }
    return second_of;
}

std::vector<CorpusPrimitive> joined(const PrimitiveClusters& clusters,
                                    const std::map<int32_t, int32_t>& second_of) {
    std::vector<CorpusPrimitive> primitives;
    for (size_t i = 0; i < clusters.primitives.size(); ++i) {
        CorpusPrimitive primitive = clusters.primitives[i];
        const auto pair = second_of.find(clusters.clusters[i]);
        if (pair != second_of.end() && i + 1 < clusters.primitives.size() &&
            clusters.clusters[i + 1] == pair->second &&
            adjoin(primitive, clusters.primitives[i + 1])) {
            primitive.rows.end = clusters.primitives[++i].rows.end;
        }
        primitives.push_back(primitive);
    }
    return primitives;
}

}  // namespace

PrimitiveClusters join_alternations(const MatrixFView& features, PrimitiveClusters clusters,
                                    const AlternationOptions& alternation,
                                    const PrimitiveClusterOptions& options, int threads) {
    if (clusters.primitives.size() != clusters.clusters.size()) {
        throw std::invalid_argument("each primitive must have one cluster");
    }
    for (;;) {
        const auto second_of = pairs_to_join(clusters, alternation);
        if (second_of.empty()) return clusters;
        clusters.primitives = joined(clusters, second_of);
        clusters.clusters = cluster_primitives(features, clusters.primitives, options, threads);
    }
}

}  // namespace kinetome
