#include "kinetome/synthesis/drift.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace kinetome;

namespace {

double spread_of(const std::vector<double>& values) {
    double sum = 0, squares = 0;
    for (const double value : values) {
        sum += value;
        squares += value * value;
    }
    const auto count = static_cast<double>(values.size());
    return std::sqrt(squares / count - (sum / count) * (sum / count));
}

}  // namespace

TEST_CASE("a drift has the spread it was asked for and moves smoothly") {
    RandomStream random(3, "drift test");
    Drift drift(2.0, 0.5, random);
    std::vector<double> values;
    double greatest_step = 0;
    for (int i = 0; i < 400'000; ++i) {
        const double value = drift.next(1.0 / 120, random);
        if (!values.empty())
            greatest_step = std::max(greatest_step, std::abs(value - values.back()));
        values.push_back(value);
    }
    CHECK(spread_of(values) == Approx(2.0).epsilon(0.05));
    CHECK(greatest_step < 0.3);
    CHECK(greatest_step > 0.01);
}

TEST_CASE("a drift forgets: values some knots apart do not depend on each other") {
    RandomStream random(4, "drift test");
    Drift drift(1.0, 0.1, random);
    std::vector<double> values;
    for (int i = 0; i < 200'000; ++i) values.push_back(drift.next(1.0 / 120, random));
    double product = 0;
    constexpr size_t apart = 60;  // 0.5 s: five knots
    for (size_t i = apart; i < values.size(); ++i) product += values[i] * values[i - apart];
    CHECK(std::abs(product / static_cast<double>(values.size())) < 0.05);
}

TEST_CASE("the quick normal numbers have mean 0 and spread 1") {
    RandomStream random(5, "drift test");
    std::vector<double> values(200'000);
    double sum = 0;
    for (double& value : values) sum += value = quick_normal(random);
    CHECK(std::abs(sum / 200'000) < 0.01);
    CHECK(spread_of(values) == Approx(1).epsilon(0.01));
}
