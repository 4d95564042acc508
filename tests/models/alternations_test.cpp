#include "kinetome/models/alternations.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "kinetome/models/take_segmentation.h"

using namespace kinetome;

TEST_CASE("halves that always follow each other become one primitive, but not across activities") {
    // Steps left and right: seven in one activity, four in the next, which begins with the right.
    MatrixF features(110, 2);
    for (int64_t i = 0; i < 110; ++i) {
        const double phase = 3.1416 * double(i % 10) / 10;
        features.row(i) << float(i / 10 % 2 == 0 ? 300 * std::sin(phase) : 0),
            float(i / 10 % 2 == 1 ? 300 * std::sin(phase) : 0);
    }
    TakePrimitives steps;
    for (int64_t step = 0; step < 11; ++step) {
        steps.primitives.push_back({{10 * step, 10 * step + 10}, step < 7 ? 0 : 1});
    }
    steps.clusters = cluster_take(features, steps.primitives, {});
    REQUIRE(steps.clusters == std::vector<int32_t>{0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0});

    const TakePrimitives joined = join_alternations(features, steps, {}, {});
    CHECK(joined.primitives == std::vector<Primitive>{{{0, 10}, 0},
                                                      {{10, 30}, 0},
                                                      {{30, 50}, 0},
                                                      {{50, 70}, 0},
                                                      {{70, 90}, 1},
                                                      {{90, 110}, 1}});
    CHECK(joined.clusters == std::vector<int32_t>{0, 1, 1, 1, 1, 1});
}

TEST_CASE("movements that follow each other now and then stay apart") {
    const MatrixF features = MatrixF::Zero(80, 2);
    TakePrimitives take;
    for (int64_t p = 0; p < 8; ++p) take.primitives.push_back({{10 * p, 10 * p + 10}, 0});
    const auto count_after = [&](const std::vector<int32_t>& order) {
        take.clusters = order;
        return join_alternations(features, take, {}, {}).primitives.size();
    };
    CHECK(count_after({0, 0, 0, 0, 0, 0, 0, 0}) == 8);  // one movement
    CHECK(count_after({0, 0, 0, 1, 1, 1, 2, 2}) == 8);  // one after another
    CHECK(count_after({0, 1, 0, 2, 0, 1, 0, 2}) == 8);  // no two always together
    CHECK(count_after({0, 1, 2, 3, 4, 5, 6, 7}) == 8);  // never again
    take.clusters.pop_back();
    CHECK_THROWS_AS(join_alternations(features, take, {}, {}), std::invalid_argument);
}

TEST_CASE("without primitives there is nothing to join") {
    CHECK(join_alternations(MatrixF(0, 45), {}, {}, {}).primitives.empty());
}
