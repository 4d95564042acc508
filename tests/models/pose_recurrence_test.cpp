#include "kinetome/models/pose_recurrence.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

/// Poses on a circle of radius 200 cm, one a frame.
MatrixF poses_at(const std::vector<double>& angles) {
    MatrixF rows(angles.size(), 2);
    for (size_t i = 0; i < angles.size(); ++i) {
        rows.row(static_cast<int64_t>(i)) << float(200 * std::cos(angles[i])),
            float(200 * std::sin(angles[i]));
    }
    return rows;
}

/// `turns` of the circle in `frames` frames.
std::vector<double> turning(double turns, int frames) {
    std::vector<double> angles;
    for (int i = 0; i < frames; ++i) angles.push_back(2 * std::numbers::pi * turns * i / frames);
    return angles;
}

}  // namespace

TEST_CASE("poses of a movement that goes round come back, those of one that goes on do not") {
    CHECK(pose_recurrence(poses_at(turning(6, 600))) == PoseRecurrence{1, 1, 600, 600});
    CHECK(pose_recurrence(poses_at(turning(0.5, 600))) == PoseRecurrence{1, 0, 600, 0});
}

TEST_CASE("a pose that is held does not come back") {
    CHECK(pose_recurrence(poses_at(std::vector<double>(600, 0.3))).recurring_takes == 0);
    RandomStream random(3, "held");
    std::vector<double> trembling;
    for (int i = 0; i < 600; ++i) trembling.push_back(0.05 * random.uniform());
    CHECK(pose_recurrence(poses_at(trembling)).recurring_takes == 0);
}

TEST_CASE("a return counts within the time allowed, in takes that are long enough") {
    const MatrixF slow = poses_at(turning(2, 620));  // comes back after 9.8 s
    CHECK(pose_recurrence(slow).recurring_takes == 1);
    PoseRecurrenceOptions hasty;
    hasty.longest_return = 9.5;
    CHECK(pose_recurrence(slow, hasty).recurring_takes == 0);
    CHECK(pose_recurrence(poses_at(turning(4, 240))) == PoseRecurrence{});
    CHECK(pose_recurrence(poses_at(turning(4, 241))).takes == 1);
}

TEST_CASE("both the pose that comes back and the one before it recur") {
    std::vector<double> angles = turning(1, 240);                         // once round …
    for (const double angle : turning(0.4, 96)) angles.push_back(angle);  // … and on a little
    const auto recurring = recurring_frames(poses_at(angles));
    CHECK(recurring[10]);
    CHECK(recurring[250]);
    CHECK(!recurring[160]);  // the far side of the circle is seen once
}
