#include "kinetome/math/quantiles.h"

#include <catch2/catch.hpp>
#include <vector>

using namespace kinetome;

TEST_CASE("of an even number of values either middle one is a median") {
    const std::vector<double> values = {8, 1, 4, 2};
    CHECK(lower_quantile(values, 0.5) == 2);
    CHECK(upper_median(values) == 4);
}

TEST_CASE("of an odd number both medians are the one in the middle") {
    const std::vector<int> values = {9, 3, 5};
    CHECK(lower_quantile(values, 0.5) == 5);
    CHECK(upper_median(values) == 5);
}

TEST_CASE("quantiles reach from the least value to the greatest") {
    const std::vector<float> values = {3, 7, 5};
    CHECK(lower_quantile(values, 0) == 3);
    CHECK(lower_quantile(values, 0.99) == 5);
    CHECK(lower_quantile(values, 1) == 7);
}

TEST_CASE("quantiles of no values are 0") {
    CHECK(lower_quantile(std::vector<double>(), 0.5) == 0);
    CHECK(upper_median(std::vector<double>()) == 0);
}
