#include "kinetome/models/ppca_segmentation.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

constexpr int64_t columns = 6;

/// Frames that swing in a plane of their own around a place of their own.
void add_behaviour(MatrixF& rows, int64_t frames, int plane, RandomStream& random) {
    const int64_t first = rows.rows();
    rows.conservativeResize(first + frames, columns);
    for (int64_t i = first; i < rows.rows(); ++i) {
        const double phase = double(i) / 12;
        for (int64_t j = 0; j < columns; ++j) rows(i, j) = float(0.02 * random.normal());
        rows(i, plane) += float(1 + std::sin(phase));
        rows(i, plane + 1) += float(std::cos(phase));
    }
}

MatrixF three_behaviours() {
    RandomStream random(4, "behaviours");
    MatrixF rows(0, columns);
    add_behaviour(rows, 700, 0, random);
    add_behaviour(rows, 600, 2, random);
    add_behaviour(rows, 800, 4, random);
    return rows;
}

}  // namespace

TEST_CASE("behaviours are cut where they change") {
    const std::vector<int64_t> cuts = ppca_cuts(three_behaviours());
    REQUIRE(cuts.size() == 2);
    CHECK(std::abs(cuts[0] - 700) <= 10);
    CHECK(std::abs(cuts[1] - 1300) <= 10);
}

TEST_CASE("a behaviour that ends soon after the take begins is found going backward") {
    RandomStream random(5, "behaviours");
    MatrixF rows(0, columns);
    add_behaviour(rows, 160, 0, random);
    add_behaviour(rows, 900, 2, random);
    const std::vector<int64_t> cuts = ppca_cuts(rows);
    REQUIRE(cuts.size() == 1);
    CHECK(std::abs(cuts[0] - 160) <= 10);
}

TEST_CASE("one behaviour, stillness and a short take are not cut") {
    RandomStream random(6, "behaviours");
    MatrixF one(0, columns);
    add_behaviour(one, 2000, 2, random);
    CHECK(ppca_cuts(one).empty());
    CHECK(ppca_cuts(MatrixF::Constant(1000, columns, 0.5F)).empty());
    CHECK(ppca_cuts(one.topRows(120)).empty());
    CHECK(ppca_segments(one.topRows(120)).size() == 1);
    CHECK(ppca_segments(MatrixF(0, columns)).empty());
}

TEST_CASE("segments follow each other, no two of one cluster") {
    const auto segments = ppca_segments(three_behaviours());
    REQUIRE(segments.size() == 3);
    int64_t end = 0;
    for (size_t s = 0; s < segments.size(); ++s) {
        CHECK(segments[s].frames.first == end);
        CHECK(segments[s].cluster == static_cast<int32_t>(s));
        end = segments[s].frames.end;
    }
    CHECK(end == 2100);
}

TEST_CASE("the distance is that of the Gaussian, its small variances evened out") {
    // Variances 4, 1 and 1/4 along the axes hold .76, .95 and 1: two axes are kept at .9, so the
    // rest is itself; one at .7, so that the others' variance becomes 5/8.
    MatrixF known(6, 3);
    known << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
    known.col(0) *= float(std::sqrt(4 * 2.5));
    known.col(1) *= float(std::sqrt(1 * 2.5));
    known.col(2) *= float(std::sqrt(0.25 * 2.5));
    MatrixF ahead(2, 3);
    ahead << 2, 1, 1, 2, 3, -1;
    CHECK(distance_from_ppca(known, ahead, 0.9) == Approx(4 / 4.0 + 5 / 1.0 + 1 / 0.25));
    CHECK(distance_from_ppca(known, ahead, 0.7) == Approx(4 / 4.0 + (5 + 1) / 0.625));
    CHECK_THROWS_AS(distance_from_ppca(known.topRows(1), ahead, 0.9), std::invalid_argument);
}
