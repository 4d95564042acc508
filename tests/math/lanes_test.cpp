#include "../../src/math/lanes.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace kinetome;

TEST_CASE("the exponential of lanes is within 3e-7 of the true one") {
    double worst = 0;
    for (int i = 0; i <= 1'000'000; ++i) {
        const float x = -87.0F * static_cast<float>(i) / 1e6F;
        const double value = double(exponential(all_lanes(x))[i % lane_count]);
        const double truth = std::exp(double(x));
        worst = std::max(worst, std::abs(value - truth) / truth);
    }
    CHECK(worst < 3e-7);
    CHECK(exponential(all_lanes(0.0F))[0] == 1.0F);
}

TEST_CASE("the exponential of lanes far below is next to nothing, not rubbish") {
    for (const float x : {-88.0F, -1e4F, -3e38F}) {
        const float value = exponential(all_lanes(x))[1];
        CHECK(value >= 0.0F);
        CHECK(value < 2e-38F);
    }
}

TEST_CASE("comparing lanes sets the bit of each lane that is greater") {
    for (int lane = 0; lane < lane_count; ++lane) {
        Lanes a{};
        a[lane] = 1;
        CHECK(lanes_greater(a, Lanes{}) == uint32_t{1} << lane);
        CHECK(any_greater(a, Lanes{}));
        CHECK_FALSE(all_greater(a, Lanes{}));
    }
    CHECK_FALSE(any_greater(Lanes{}, Lanes{}));
    CHECK(all_greater(all_lanes(2.0F), all_lanes(1.0F)));
}
