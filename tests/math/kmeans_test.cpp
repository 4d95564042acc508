#include "kinetome/math/kmeans.h"

#include <catch2/catch.hpp>
#include <set>
#include <stdexcept>

#include "kinetome/base/random.h"

using namespace kinetome;

TEST_CASE("k-means finds groups that lie apart, whatever the start") {
    RandomStream random(5, "groups");
    MatrixD rows(90, 2);
    for (int64_t i = 0; i < 90; ++i) {
        rows.row(i) << 20 * double(i % 3) + random.normal(), 7 * double(i % 3) + random.normal();
    }
    for (uint64_t seed = 1; seed < 8; ++seed) {
        const auto clusters = kmeans(rows, {.clusters = 3, .seed = seed});
        for (size_t i = 3; i < 90; ++i) CHECK(clusters[i] == clusters[i % 3]);
        CHECK(std::set<int32_t>(clusters.begin(), clusters.end()).size() == 3);
    }
}

TEST_CASE("k-means of fewer distinct rows than clusters gives each its own") {
    const MatrixD rows = MatrixD::Constant(5, 3, 2);
    CHECK(kmeans(rows, {.clusters = 4}) == std::vector<int32_t>(5, 0));
    MatrixD two = rows;
    two(4, 0) = 3;
    const auto clusters = kmeans(two, {.clusters = 4});
    CHECK(clusters[0] == clusters[3]);
    CHECK(clusters[0] != clusters[4]);
    CHECK(kmeans(MatrixD(0, 3), {}).empty());
    CHECK_THROWS_AS(kmeans(rows, {.clusters = 0}), std::invalid_argument);
}
