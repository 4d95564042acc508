#include "kinetome/formats/resample.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "kinetome/formats/kinematics.h"
#include "small_rig.h"

using namespace kinetome;

namespace {

std::span<const float> frame_of(const Clip& clip, int64_t row) {
    return {clip.motion.row(row).data(), static_cast<size_t>(clip.motion.cols())};
}

/// The root turns about a fixed skew axis at a constant speed; angles are its own.
Clip steady_turn(int64_t frames, double rate, double radians_per_second) {
    Clip clip = small_motion(frames, rate);
    clip.motion.setZero();
    const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -1).normalized();
    for (int64_t row = 0; row < frames; ++row) {
        const double angle = radians_per_second * static_cast<double>(row) / rate;
        const Eigen::Matrix3d rotation = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
        clip.motion(row, 3) = static_cast<float>(std::atan2(rotation(2, 1), rotation(2, 2)));
        clip.motion(row, 4) = static_cast<float>(std::asin(-rotation(2, 0)));
        clip.motion(row, 5) = static_cast<float>(std::atan2(rotation(1, 0), rotation(0, 0)));
    }
    return clip;
}

}  // namespace

TEST_CASE("at an equal rate nothing changes, at a quarter every fourth frame is picked") {
    const Clip clip = small_motion(101);
    CHECK(resample(clip, 120).motion == clip.motion);
    const Clip quarter = resample(clip, 30);
    REQUIRE(quarter.frames() == 26);
    CHECK(quarter.rate == 30.0);
    for (int64_t row = 0; row < quarter.frames(); ++row) {
        CHECK(quarter.motion.row(row) == clip.motion.row(4 * row));
    }
}

TEST_CASE("frames on common instants are kept to the last bit at odd ratios") {
    const Clip clip = small_motion(121);
    const Clip fifty = resample(clip, 50);
    REQUIRE(fifty.frames() == 51);
    for (int64_t row = 0; row < 51; row += 5) {
        CHECK(fifty.motion.row(row) == clip.motion.row(12 * row / 5));
    }
}

TEST_CASE("a joint that turns at a constant speed about a skew axis still does when resampled") {
    const Clip slow = steady_turn(61, 30, 2.5);
    const Clip quick = resample(slow, 120);
    const Clip truth = steady_turn(241, 120, 2.5);
    REQUIRE(quick.frames() == truth.frames());
    for (int64_t row = 0; row < quick.frames(); ++row) {
        const Pose found = forward_kinematics(*quick.skeleton, frame_of(quick, row));
        const Pose expected = forward_kinematics(*truth.skeleton, frame_of(truth, row));
        CHECK((found.rotations[0] - expected.rotations[0]).norm() < 1e-5);
    }
}

TEST_CASE("angles that jump by a whole turn in the source do not spin between its frames") {
    Clip clip = small_motion(2, 60);
    clip.motion.setZero();
    const int knee = clip.skeleton->first_dof(3);
    clip.motion(0, knee) = 3.1F;
    clip.motion(1, knee) = -3.1F;
    clip.motion(0, 4) = 3.1F;
    clip.motion(1, 4) = -3.1F;
    const Clip twice = resample(clip, 120);
    REQUIRE(twice.frames() == 3);
    CHECK(std::abs(twice.motion(1, knee)) == Approx(std::numbers::pi).margin(1e-6));
    CHECK(std::cos(twice.motion(1, 4)) == Approx(-1.0).margin(1e-6));
}

TEST_CASE("resampled angles stay on the branch of the source") {
    const Clip clip = small_motion(100, 40);
    const Clip finer = resample(clip, 120);
    for (int64_t row = 0; row < finer.frames(); ++row) {
        const Eigen::RowVectorXf nearest = clip.motion.row((row + 1) / 3);
        CHECK((finer.motion.row(row) - nearest).tail(12).cwiseAbs().maxCoeff() < 0.2F);
    }
}

TEST_CASE("positions move on straight lines") {
    const Clip clip = small_motion(3, 60);
    const Clip twice = resample(clip, 120);
    CHECK(twice.motion(1, 0) == Approx((clip.motion(0, 0) + clip.motion(1, 0)) / 2));
}

TEST_CASE("rows end where the source ends, whatever the rates") {
    CHECK(resampled_frames(0, 120, 30) == 0);
    CHECK(resampled_frames(1, 120, 30) == 1);
    CHECK(resampled_frames(4, 120, 30) == 1);
    CHECK(resampled_frames(5, 120, 30) == 2);
    CHECK(resampled_frames(100, 60, 120) == 199);
    for (const double rate : {23.976, 25.0, 29.97, 59.94, 100.0, 240.0}) {
        for (int64_t frames = 1; frames < 400; ++frames) {
            const int64_t rows = resampled_frames(frames, rate, 120);
            CHECK(source_frame(rows - 1, rate, 120) <= static_cast<double>(frames - 1));
            CHECK(source_frame(rows, rate, 120) > static_cast<double>(frames - 1));
        }
    }
}

TEST_CASE("a rate that is none is refused") {
    const Clip clip = small_motion(2);
    for (const double rate : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
        CHECK_THROWS_AS(resample(clip, rate), std::invalid_argument);
    }
}
