#include "kinetome/formats/write_amc.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "kinetome/formats/kinematics.h"
#include "real_takes.h"
#include "small_rig.h"
#include "support/test_corpus.h"

using namespace kinetome;

namespace {

Clip written_and_read(const Clip& clip) {
    const auto skeleton =
        std::make_shared<const Skeleton>(parse_asf(write_asf(*clip.skeleton), "written.asf"));
    return parse_amc(write_amc(clip), "written.amc", skeleton, {.rate = clip.rate});
}

void check_same_motion(const Clip& clip) {
    const Clip again = written_and_read(clip);
    REQUIRE(again.frames() == clip.frames());
    CHECK(again.skeleton->class_name() == clip.skeleton->class_name());
    constexpr float thousandth_of_degree = 1.745e-5F;
    const MatrixF difference = (again.motion - clip.motion).cwiseAbs();
    CHECK(difference.leftCols(3).maxCoeff() < 1e-3F);  // the root's place, cm
    CHECK(difference.rightCols(difference.cols() - 3).maxCoeff() < thousandth_of_degree);
    CHECK((joint_positions(again) - joint_positions(clip)).cwiseAbs().maxCoeff() < 1e-3F);
}

}  // namespace

TEST_CASE("a generated take reads back from ASF and AMC to the same motion") {
    check_same_motion(small_motion(200));
}

TEST_CASE("real takes read back from ASF and AMC to the same motion") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    for (const RealTake& take : real_takes(*corpus)) {
        INFO(take.amc_path);
        check_same_motion(take.clip());
    }
}

TEST_CASE("limits, axes and units come back from a written ASF") {
    const Skeleton skeleton = *small_skeleton();
    const Skeleton again = parse_asf(write_asf(skeleton), "a");
    CHECK(again.name() == skeleton.name());
    CHECK(again.source_units().length == Approx(skeleton.source_units().length));
    for (size_t j = 0; j < skeleton.joints().size(); ++j) {
        const Joint& expected = skeleton.joints()[j];
        const Joint& found = again.joints()[j];
        CHECK(found.axes.isApprox(expected.axes, 1e-9));
        CHECK((found.offset_after - expected.offset_after).norm() < 1e-9);
        REQUIRE(found.limits.size() == expected.limits.size());
        for (size_t i = 0; i < found.limits.size(); ++i) {
            CHECK(found.limits[i].second == Approx(expected.limits[i].second));
        }
    }
}

TEST_CASE("a frame that is not finite or not of the skeleton is not written") {
    std::string text;
    std::vector<float> dofs(15);
    CHECK_THROWS_AS(append_amc_frame(text, *small_skeleton(), 1, std::vector<float>(14)),
                    std::invalid_argument);
    dofs[7] = std::numeric_limits<float>::infinity();
    CHECK_THROWS_AS(append_amc_frame(text, *small_skeleton(), 1, dofs), std::invalid_argument);
}

TEST_CASE("a rig that ASF cannot hold is refused, not bent") {
    Joint hips{.name = "root", .channels = {Channel::rz}};
    Joint knee{.name = "knee", .parent = 0, .channels = {Channel::rx}};
    CHECK_NOTHROW(write_asf(Skeleton("rig", {hips, knee})));
    knee.offset_before = {0, -40, 0};
    CHECK_THROWS_AS(write_asf(Skeleton("rig", {hips, knee})), std::invalid_argument);
    knee.offset_before.setZero();
    knee.first_rotation_acts_first = false;
    CHECK_THROWS_AS(write_asf(Skeleton("rig", {hips, knee})), std::invalid_argument);
    hips.name = "Hips";
    CHECK_THROWS_AS(write_asf(Skeleton("rig", {hips})), std::invalid_argument);
}
