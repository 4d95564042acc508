#include "kinetome/models/alternations.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "kinetome/models/take_segmentation.h"

namespace kinetome {
namespace {

bool adjoin(const Primitive& first, const Primitive& second) {
    return first.activity == second.activity && first.frames.end == second.frames.first;
}

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

    explicit Successions(const TakePrimitives& take) {
        int64_t chain = 0;
        for (size_t i = 0; i + 1 < take.primitives.size(); ++i) {
            if (!adjoin(take.primitives[i], take.primitives[i + 1])) {
                ++chain;
                continue;
            }
            const Pair pair{take.clusters[i], take.clusters[i + 1]};
            pairs[pair].occur_in(chain);
            ++followed[pair.first];
            ++preceded[pair.second];
        }
    }
};

/// The pairs to join, no cluster in two of them: the second of each by its first.
std::map<int32_t, int32_t> pairs_to_join(const TakePrimitives& take,
                                         const AlternationOptions& options) {
    const Successions successions(take);
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

std::vector<Primitive> joined(const TakePrimitives& take,
                              const std::map<int32_t, int32_t>& second_of) {
    std::vector<Primitive> primitives;
    for (size_t i = 0; i < take.clusters.size(); ++i) {
        Primitive primitive = take.primitives[i];
        const auto pair = second_of.find(take.clusters[i]);
        if (pair != second_of.end() && i + 1 < take.clusters.size() &&
            take.clusters[i + 1] == pair->second && adjoin(primitive, take.primitives[i + 1])) {
            primitive.frames.end = take.primitives[++i].frames.end;
        }
        primitives.push_back(primitive);
    }
    return primitives;
}

}  // namespace

TakePrimitives join_alternations(const MatrixFView& features, TakePrimitives take,
                                 const AlternationOptions& alternation,
                                 const PrimitiveClusterOptions& options) {
    if (take.primitives.size() != take.clusters.size()) {
        throw std::invalid_argument("each primitive must have one cluster");
    }
    for (;;) {
        const auto second_of = pairs_to_join(take, alternation);
        if (second_of.empty()) return take;
        take.primitives = joined(take, second_of);
        take.clusters = cluster_take(features, take.primitives, options);
    }
}

}  // namespace kinetome
