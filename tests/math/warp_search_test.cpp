#include "kinetome/math/warp_search.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// A walk through space, as motion is one; its rows resemble those nearby in time.
MatrixF wandering(int64_t rows, int64_t columns, RandomStream& random) {
    MatrixF walk(rows, columns);
    for (int64_t i = 0; i < rows; ++i) {
        for (int64_t c = 0; c < columns; ++c) {
            walk(i, c) = float(3 * random.normal()) + (i > 0 ? walk(i - 1, c) : 0.0F);
        }
    }
    return walk;
}

std::vector<RowRange> pieces(int64_t rows, RandomStream& random) {
    std::vector<RowRange> ranges;
    for (int64_t first = 0; first < rows;) {
        const int64_t end = std::min(rows, first + 1 + int64_t(random.below(60)));
        ranges.push_back({first, end});
        first = end + int64_t(random.below(3));
    }
    return ranges;
}

double cheapest_match(const MatrixFView& query, const MatrixFView& sequence,
                      const std::vector<WarpStep>& steps) {
    double cost = infinite;
    for (const WarpPath& path : warp_matches(query, sequence, {infinite, steps})) {
        cost = std::min(cost, path.mean);
    }
    return cost;
}

}  // namespace

TEST_CASE("what bounds spare is exactly what every match would have cost") {
    RandomStream random(4, "warp search");
    const std::vector<std::vector<WarpStep>> all_steps{
        slope_limited_steps(), {{1, 0}, {1, 1}, {1, 3}}, {{2, 1}, {3, 2}}};
    int64_t found = 0, given_up = 0;
    for (const std::vector<WarpStep>& steps : all_steps) {
        const MatrixF rows = wandering(700, 6, random);
        const std::vector<RowRange> ranges = pieces(rows.rows(), random);
        const WarpSearch search(rows, ranges, steps);
        for (int64_t first = 0; first < 600; first += 61) {
            const int64_t length = 1 + int64_t(random.below(40));
            const MatrixF asked = rows.middleRows(first, length).array() + float(random.normal());
            const WarpQuery query = search.query(asked);
            for (int64_t s = 0; s < search.sequences(); ++s) {
                const double cost = cheapest_match(asked, search.rows_of(s), steps);
                CHECK(query.bound(s) <= cost);
                CHECK(query.cost(s, infinite) == cost);
                CHECK(query.cost(s, cost) == cost);
                if (cost == infinite) continue;
                CHECK(query.cost(s, std::nextafter(cost, 0.0)) == infinite);
                const double at_most = random.uniform(0, 100);
                CHECK(query.cost(s, at_most) == (cost <= at_most ? cost : infinite));
                ++(cost <= at_most ? found : given_up);
            }
        }
    }
    CHECK(found > 50);
    CHECK(given_up > 50);
}

TEST_CASE("bounds rise where sequences are far away") {
    RandomStream random(5, "warp search");
    const MatrixF near = wandering(40, 9, random);
    MatrixF rows(80, 9);
    rows << near, near.array() + 50.0F;
    const std::vector<RowRange> ranges{{0, 40}, {40, 80}};
    const WarpSearch search(rows, ranges);
    const WarpQuery query = search.query(near);
    CHECK(query.bound(0) == 0);
    CHECK(query.bound(1) > 50);
    CHECK(query.cost(0, 0) == 0);
}

TEST_CASE("a query finds no sequence that is shorter than half its length") {
    const MatrixF rows = MatrixF::Zero(30, 2);
    const std::vector<RowRange> ranges{{0, 9}, {0, 10}};
    const WarpSearch search(rows, ranges);
    const WarpQuery query = search.query(rows.topRows(20));
    CHECK(query.cost(0, infinite) == infinite);
    CHECK(query.cost(1, infinite) == infinite);  // the first row needs a column of its own
    CHECK(search.query(rows.topRows(19)).cost(1, infinite) == 0);
}

TEST_CASE("what cannot be searched is refused") {
    MatrixF rows = MatrixF::Zero(20, 3);
    const std::vector<RowRange> whole{{0, 20}}, empty{{5, 5}}, outside{{10, 21}};
    CHECK_THROWS_AS(WarpSearch(rows, empty), std::invalid_argument);
    CHECK_THROWS_AS(WarpSearch(rows, outside), std::invalid_argument);
    CHECK_THROWS_AS(WarpSearch(rows, whole, {{0, 1}, {1, 1}}), std::invalid_argument);
    CHECK_THROWS_AS(WarpSearch(rows, whole, {}), std::invalid_argument);
    const WarpSearch search(rows, whole);
    CHECK_THROWS_AS(search.query(rows.topRows(0)), std::invalid_argument);
    CHECK_THROWS_AS(search.query(MatrixF::Zero(5, 4)), std::invalid_argument);
    rows(3, 1) = std::nanf("");
    CHECK_THROWS_AS(search.query(rows), std::invalid_argument);
    CHECK_THROWS_AS(WarpSearch(rows, whole), std::invalid_argument);
}
