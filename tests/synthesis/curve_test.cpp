#include "kinetome/synthesis/curve.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

using namespace kinetome;

TEST_CASE("a curve goes through its keys, in every period, and comes back to the first") {
    const Curve curve = {{0.1, 2}, {0.4, -1}, {0.9, 5}};
    for (const int period : {-3, 0, 1, 7}) {
        CHECK(curve(period + 0.1) == Approx(2));
        CHECK(curve(period + 0.4) == Approx(-1));
        CHECK(curve(period + 0.9) == Approx(5));
    }
    CHECK(curve(0) == Approx(curve(1)));
    CHECK(curve(1 - 1e-9) == Approx(curve(0)).margin(1e-6));
}

TEST_CASE("a curve never overshoots its keys: a resting hand must not tremble") {
    const Curve curve = {{0.0, 0}, {0.12, -0.1}, {0.36, 1}, {0.42, 0.97}, {0.72, 0.04}, {0.85, 0}};
    for (int i = 0; i < 2000; ++i) {
        CHECK(curve(i / 2000.0) <= 1 + 1e-12);
        CHECK(curve(i / 2000.0) >= -0.1 - 1e-12);
    }
    const Curve flat = {{0.0, 3}, {0.5, 3}};
    CHECK(flat(0.3) == Approx(3));
}

TEST_CASE("a curve has no corners, not even where its period ends") {
    const Curve curve = {{0.0, 0}, {0.2, 1}, {0.3, 4}, {0.7, 2}};
    constexpr double step = 1e-5;
    for (int i = -100; i < 1100; ++i) {
        const double at = i / 1000.0;
        const double before = (curve(at) - curve(at - step)) / step;
        const double after = (curve(at + step) - curve(at)) / step;
        CHECK(std::abs(after - before) < 0.05);
    }
}

TEST_CASE("keys out of order or out of the period are refused") {
    CHECK_THROWS_AS((Curve{}), std::invalid_argument);
    CHECK_THROWS_AS((Curve{{0.5, 1}, {0.5, 2}}), std::invalid_argument);
    CHECK_THROWS_AS((Curve{{0.5, 1}, {0.2, 2}}), std::invalid_argument);
    CHECK_THROWS_AS((Curve{{0.0, 1}, {1.0, 2}}), std::invalid_argument);
    CHECK_THROWS_AS((Curve{{-0.1, 1}}), std::invalid_argument);
}
