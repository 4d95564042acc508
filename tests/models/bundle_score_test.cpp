#include "kinetome/models/bundle_score.h"

#include <catch2/catch.hpp>
#include <vector>

using namespace kinetome;

TEST_CASE("purity counts frames of a bundle's main class") {
    // One clip of 100 frames of class 0 and 100 of class 1, one without labels.
    FrameClasses classes(200, 0);
    for (size_t i = 100; i < 200; ++i) classes[i] = 1;
    const std::vector<FrameClasses> clips = {classes, {}};
    const std::vector<MotionPiece> members = {
        {0, 0, 40}, {0, 40, 60}, {0, 90, 120}, {0, 120, 130}, {1, 0, 1000}};
    const std::vector<int32_t> bundle_of = {0, 0, 7, 7, 7};
    const BundleScore score = score_bundles(members, bundle_of, clips);
    CHECK(score.purity == Approx((60 + 30) / 100.0));
    CHECK(score.coverage == Approx(100 / 200.0));
    CHECK(score.chance == Approx(0.5));
    CHECK(score.bundles == 2);
    CHECK(score.mean_height == 2);
    CHECK(score.median_width == 30);
}

TEST_CASE("frames without a class count as covered, not as pure or impure") {
    FrameClasses classes(10, no_class);
    classes[0] = 3;
    const std::vector<MotionPiece> members = {{0, 0, 5}, {0, 5, 10}};
    const BundleScore score =
        score_bundles(members, std::vector<int32_t>{0, 0}, std::vector<FrameClasses>{classes});
    CHECK(score.purity == 1);
    CHECK(score.coverage == 1);
}

TEST_CASE("members dealt out at random are as impure as chance makes them") {
    FrameClasses classes(4000, 0);
    for (size_t i = 0; i < classes.size(); ++i) classes[i] = static_cast<int32_t>(i / 1000);
    std::vector<MotionPiece> members;
    std::vector<int32_t> bundle_of;
    for (int64_t i = 0; i < 400; ++i) {
        members.push_back({0, 10 * i, 10 * i + 10});
        bundle_of.push_back(static_cast<int32_t>(i / 100));
    }
    const BundleScore score = score_bundles(members, bundle_of, std::vector<FrameClasses>{classes});
    CHECK(score.purity == 1);
    CHECK(score.shuffled < 0.4);
    CHECK(score_bundles({}, {}, {}).purity == 0);
}

TEST_CASE("scores of what does not fit together are refused") {
    const std::vector<FrameClasses> clips = {FrameClasses(10, 0)};
    const auto score = [&](const MotionPiece& member) {
        return score_bundles(std::vector<MotionPiece>{member}, std::vector<int32_t>{0}, clips);
    };
    CHECK_NOTHROW(score({0, 0, 10}));
    CHECK_THROWS_AS(score({0, 0, 11}), std::invalid_argument);
    CHECK_THROWS_AS(score({1, 0, 5}), std::invalid_argument);
    CHECK_THROWS_AS(score_bundles({}, std::vector<int32_t>{0}, clips), std::invalid_argument);
}
