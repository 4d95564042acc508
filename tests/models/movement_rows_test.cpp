#include "kinetome/models/movement_rows.h"

#include <catch2/catch.hpp>
#include <limits>

using namespace kinetome;

TEST_CASE("rows of a movement keep half of its mean pose and gain the way of the pose") {
    MatrixF stacked(3, 6);           // poses of two columns: before, now, after
    stacked << 0, 10, 1, 11, 2, 12,  //
        1, 11, 2, 12, 4, 13,         //
        7, 7, 7, 7, 7, 7;
    const std::vector<CorpusPrimitive> one{{0, {0, 2}}};
    const MatrixF rows = movement_rows(stacked, one);
    REQUIRE(rows.cols() == 8);
    CHECK(rows(0, 0) == -0.25F);  // mean 0.5
    CHECK(rows(1, 4) == 2.5F);    // mean 3
    CHECK(rows(0, 6) == 8);       // 4 × (2 − 0)
    CHECK(rows(1, 7) == 8);
    CHECK(rows.row(2).head(6) == stacked.row(2));
    CHECK(rows.row(2).tail(2).isZero());

    const MatrixF whole = movement_rows(stacked, one, {1, 0});
    CHECK(whole.leftCols(6) == stacked);
    CHECK(whole.rightCols(2).isZero());
}

TEST_CASE("movements of performers who stand differently are nearer than their poses") {
    RowRange rows{0, 12};
    MatrixF first(12, 3), second(12, 3);
    for (int64_t i = 0; i < 12; ++i) {
        first.row(i) << float(i), float(i + 1), float(i + 2);
        second.row(i) = first.row(i).array() + 30.0F;
    }
    const std::vector<CorpusPrimitive> one{{0, rows}};
    const MatrixF apart = movement_rows(first, one) - movement_rows(second, one);
    CHECK(apart.norm() == Approx(0.5 * (first - second).norm()));
}

TEST_CASE("rows that are no movements are refused") {
    MatrixF rows = MatrixF::Zero(6, 6);
    const std::vector<CorpusPrimitive> one{{0, {2, 4}}}, outside{{0, {4, 7}}};
    CHECK_THROWS_AS(movement_rows(rows.leftCols(4), one), std::invalid_argument);
    CHECK_THROWS_AS(movement_rows(rows, outside), std::invalid_argument);
    rows(2, 0) = std::numeric_limits<float>::infinity();
    CHECK_THROWS_AS(movement_rows(rows, one), std::invalid_argument);
}
