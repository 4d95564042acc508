#include "kinetome/models/primitive_score.h"

#include <catch2/catch.hpp>
#include <stdexcept>

using namespace kinetome;

namespace {

/// a until 40, b until 80, a until 100; uncertain from 36 to 44.
TruthTimeline toy_truth() {
    const std::vector<TruthRow> rows = {
        {"t", 0, 40, "a", 36, 44}, {"t", 40, 80, "b", 80, 80}, {"t", 80, 100, "a", 100, 100}};
    return truth_timeline(rows, 100, 10, "truth.csv");
}

}  // namespace

TEST_CASE("primitives are counted in the activity that holds their middle") {
    const std::vector<RowRange> cycles = {{0, 20}, {20, 40}, {40, 60}, {60, 80}};
    const std::vector<RowRange> primitives = {{0, 18},  {18, 50},            // a: 2 of 2
                                              {50, 62}, {62, 70}, {70, 80},  // b: 3 of 2
                                              {80, 100}};                    // no cycles there
    const std::vector<int32_t> clusters(primitives.size(), 0);
    const PrimitiveScore score = score_primitives(toy_truth(), cycles, primitives, clusters);
    CHECK(score.activities == 2);
    CHECK(score.exact == 1);
    CHECK(score.within_one == 2);
    CHECK(score.exact_share() == 0.5);
    CHECK(score.primitives == 6);
    CHECK(score.cycles == 4);
}

TEST_CASE("a cluster is pure as far as its primitives are of one class") {
    const std::vector<RowRange> primitives = {{0, 20}, {20, 48}, {45, 80}, {80, 100}, {37, 43}};
    CHECK(classes_of_primitives(toy_truth(), primitives) == std::vector<int32_t>{0, 0, 1, 0, -1});
    const auto purity = [&](const std::vector<int32_t>& clusters) {
        return score_primitives(toy_truth(), {}, primitives, clusters).purity();
    };
    CHECK(purity({0, 0, 1, 0, 1}) == 1.0);  // the uncertain one does not count
    CHECK(purity({0, 0, 0, 0, 0}) == 0.75);
    CHECK(purity({0, 1, 1, 2, 3}) == 0.75);
    CHECK_THROWS_AS(purity({0, 0}), std::invalid_argument);
    CHECK_THROWS_AS(classes_of_primitives(toy_truth(), std::vector<RowRange>{{90, 101}}),
                    std::invalid_argument);
}

TEST_CASE("scores of takes add up before shares are taken") {
    PrimitiveScore sum{.activities = 1, .exact = 1, .within_one = 1};
    sum += PrimitiveScore{.activities = 3, .exact = 0, .within_one = 2, .classified = 4, .pure = 1};
    CHECK(sum.exact_share() == 0.25);
    CHECK(sum.within_one_share() == 0.75);
    CHECK(sum.purity() == 0.25);
    CHECK(PrimitiveScore{}.purity() == 0);
}
