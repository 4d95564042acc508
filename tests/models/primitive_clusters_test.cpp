#include "kinetome/models/primitive_clusters.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>

#include "generated_primitives.h"
#include "kinetome/base/random.h"
#include "kinetome/math/warp.h"

using namespace kinetome;

namespace {

/// Cycles of a few movements, each of its own place, extent and tempo, at wandering speed.
struct Movements {
    MatrixF features;
    std::vector<CorpusPrimitive> primitives;
};

Movements movements(int64_t count, int64_t kinds, double unlike) {
    RandomStream random(11, "movements");
    Movements result;
    std::vector<VectorF> rows;
    for (int64_t p = 0; p < count; ++p) {
        RandomStream kind(5, "kind", random.below(static_cast<uint64_t>(kinds)));
        const VectorF place =
            VectorF::NullaryExpr(6, [&] { return float(unlike * kind.normal()); });
        const VectorF extent =
            VectorF::NullaryExpr(6, [&] { return float(unlike * kind.normal()); });
        const auto first = static_cast<int64_t>(rows.size());
        const auto frames = static_cast<int64_t>(random.uniform(8, 40));
        const double lag = random.uniform(0, 0.5);
        for (int64_t i = 0; i < frames; ++i) {
            const double phase = 6.28 * (double(i) / double(frames) + lag);
            rows.push_back(place + float(std::sin(phase)) * extent);
        }
        result.primitives.push_back({p / 10, {first, first + frames}});
    }
    result.features.resize(static_cast<int64_t>(rows.size()), 6);
    for (size_t i = 0; i < rows.size(); ++i) result.features.row(int64_t(i)) = rows[i];
    return result;
}

auto rows_of(const Movements& all, size_t primitive) {
    const RowRange& rows = all.primitives[primitive].rows;
    return all.features.middleRows(rows.first, rows.size());
}

/// Gives both clusters the lower number.
void merge(std::vector<int32_t>& clusters, size_t a, size_t b) {
    const int32_t low = std::min(clusters[a], clusters[b]),
                  high = std::max(clusters[a], clusters[b]);
    std::ranges::replace(clusters, high, low);
}

/// Compares every pair.
std::vector<int32_t> clusters_of_all_pairs(const Movements& all,
                                           const PrimitiveClusterOptions& options) {
    const size_t count = all.primitives.size();
    const WarpOptions warping{slope_limited_steps(), WarpWeight::both, 1, options.radius};
    std::vector<std::vector<bool>> joined(count, std::vector<bool>(count));
    std::vector<int32_t> of_clips(count);
    std::iota(of_clips.begin(), of_clips.end(), 0);
    for (size_t a = 0; a < count; ++a) {
        for (size_t b = 0; b < count; ++b) {
            joined[a][b] =
                warp_cost(rows_of(all, a), rows_of(all, b), warping) <= options.threshold;
            if (joined[a][b] && all.primitives[a].clip == all.primitives[b].clip) {
                merge(of_clips, a, b);
            }
        }
    }
    std::vector<int32_t> clusters = of_clips;
    for (size_t a = 0; a < count; ++a) {
        for (size_t b = 0; b < a; ++b) {
            if (all.primitives[a].clip == all.primitives[b].clip) continue;
            double pairs = 0, edges = 0;
            for (size_t x = 0; x < count; ++x) {
                for (size_t y = 0; y < count; ++y) {
                    if (of_clips[x] != of_clips[a] || of_clips[y] != of_clips[b]) continue;
                    ++pairs;
                    edges += joined[x][y] ? 1 : 0;
                }
            }
            if (edges > 0 && edges >= options.share_across * pairs) merge(clusters, a, b);
        }
    }
    std::map<int32_t, int32_t> numbers;
    for (int32_t& cluster : clusters) {
        cluster = numbers.emplace(cluster, static_cast<int32_t>(numbers.size())).first->second;
    }
    return clusters;
}

std::vector<CorpusPrimitive> even_primitives(int64_t count, int64_t frames) {
    std::vector<CorpusPrimitive> primitives;
    for (int64_t p = 0; p < count; ++p) primitives.push_back({0, {p * frames, (p + 1) * frames}});
    return primitives;
}

}  // namespace

TEST_CASE("clusters are those of comparing every pair, whatever the threads") {
    const Movements all = movements(150, 12, 20);
    std::set<size_t> counts;
    for (const double threshold : {0.0, 8.0, 15.0, 30.0}) {
        for (const double radius : {20.0, 60.0, 1000.0}) {
            for (const double share : {0.0, 0.5, 1.0}) {
                const PrimitiveClusterOptions options{threshold, radius, share};
                const auto expected = clusters_of_all_pairs(all, options);
                for (const int threads : {1, 3}) {
                    CHECK(cluster_primitives(all.features, all.primitives, options, threads) ==
                          expected);
                }
                counts.insert(std::set(expected.begin(), expected.end()).size());
            }
        }
    }
    CHECK(counts.size() >= 8);
}

TEST_CASE("primitives that are the same are one cluster, whatever their number") {
    const MatrixF still = MatrixF::Constant(2000, 45, 3.5F);
    const auto clusters = cluster_primitives(still, even_primitives(200, 10), {}, 2);
    CHECK(clusters == std::vector<int32_t>(200, 0));
    const Movements one = movements(1, 1, 30);
    const std::vector<CorpusPrimitive> twice(50, one.primitives.front());
    CHECK(cluster_primitives(one.features, twice, {0, 0}, 1) == std::vector<int32_t>(50, 0));
}

TEST_CASE("primitives of one frame are joined by their distance") {
    MatrixF places(5, 2);
    places << 0, 0, 30, 40, 300, 0, 300, 56.5F, 355, 0;
    CHECK(cluster_primitives(places, even_primitives(5, 1), {}, 1) ==
          std::vector<int32_t>{0, 0, 1, 2, 1});
}

TEST_CASE("no primitives have no clusters") {
    CHECK(cluster_primitives(MatrixF(0, 45), {}, {}, 2).empty());
}

TEST_CASE("primitives that cannot be compared are refused, with their rows") {
    MatrixF features = MatrixF::Zero(20, 3);
    const auto cluster = [&](RowRange rows) {
        return cluster_primitives(features, std::vector<CorpusPrimitive>{{0, rows}}, {}, 1);
    };
    CHECK_THROWS_AS(cluster({4, 4}), std::invalid_argument);
    CHECK_THROWS_AS(cluster({-1, 4}), std::invalid_argument);
    CHECK_THROWS_AS(cluster({15, 21}), std::invalid_argument);
    features(7, 1) = std::numeric_limits<float>::quiet_NaN();
    CHECK_NOTHROW(cluster({0, 7}));
    CHECK_THROWS_WITH(cluster({5, 9}), Catch::Contains("[5, 9)"));
    CHECK_THROWS_AS(cluster_primitives(features, {}, {-1}, 1), std::invalid_argument);
    CHECK_THROWS_AS(cluster_primitives(features, {}, {1, 1, 1.5}, 1), std::invalid_argument);
}

TEST_CASE("clusters of generated cycles hold one activity each") {
    const GeneratedPrimitives generated = generated_primitives(40);
    const auto clusters = cluster_primitives(generated.features, generated.primitives, {}, 2);
    std::map<int32_t, std::map<std::string, int64_t>> labels;
    for (size_t i = 0; i < clusters.size(); ++i) ++labels[clusters[i]][generated.labels[i]];
    int64_t agreed = 0;
    for (const auto& [cluster, counts] : labels) {
        int64_t most = 0;
        for (const auto& [label, count] : counts) most = std::max(most, count);
        agreed += most;
    }
    CAPTURE(clusters.size(), labels.size());
    CHECK(double(agreed) >= 0.99 * double(clusters.size()));
    CHECK(3 * labels.size() < clusters.size());
}
