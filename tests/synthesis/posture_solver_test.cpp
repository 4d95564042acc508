#include "kinetome/synthesis/posture_solver.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "kinetome/formats/kinematics.h"
#include "kinetome/synthesis/activity.h"

using namespace kinetome;

namespace {

constexpr double degree = std::numbers::pi / 180;

/// A skeleton, its solver and the pose of what was solved last.
struct Stage {
    Body body{180};
    Skeleton skeleton = make_skeleton(body, "01");
    PostureSolver solver{body, skeleton};
    std::vector<double> dofs = std::vector<double>(62);
    Pose pose;

    void solve(const Posture& posture, const TravelFrame& travel = {}) {
        solver.solve(posture, travel, dofs);
        const std::vector<float> narrow(dofs.begin(), dofs.end());
        pose = forward_kinematics(skeleton, narrow);
    }
    Eigen::Vector3d at(const char* joint) const {
        return pose.positions[static_cast<size_t>(*skeleton.find(joint))];
    }
};

Posture standing() {
    Posture posture;
    posture[Trunk::pelvis_height] = 0.9;
    for (const Side side : both_sides) posture.leg(side)[Leg::out] = 0.12;
    return posture;
}

}  // namespace

TEST_CASE("feet stand where the posture puts them, whatever the pelvis does") {
    Stage stage;
    Posture posture = standing();
    posture.leg(Side::left)[Leg::ahead] = 0.3;
    posture.leg(Side::right)[Leg::ahead] = -0.2;
    for (const double turn : {-25.0, 0.0, 25.0}) {
        posture[Trunk::pelvis_yaw] = turn * degree;
        posture[Trunk::pelvis_pitch] = 0.6 * turn * degree;
        posture[Trunk::pelvis_roll] = 0.2 * turn * degree;
        posture[Trunk::pelvis_height] = 0.8;
        stage.solve(posture);
        const Eigen::Vector3d left = stage.at("ltibia"), right = stage.at("rtibia");
        CHECK((left - Eigen::Vector3d(0.12 * stage.body.leg(), stage.body.ankle_height,
                                      0.3 * stage.body.leg()))
                  .norm() < 1e-3);
        CHECK((right - Eigen::Vector3d(-0.12 * stage.body.leg(), stage.body.ankle_height,
                                       -0.2 * stage.body.leg()))
                  .norm() < 1e-3);
    }
}

TEST_CASE("a flat sole is level and its ball as high as the body says, a raised heel turns on it") {
    Stage stage;
    Posture posture = standing();
    stage.solve(posture);
    const Eigen::Vector3d flat = stage.at("lfoot");
    CHECK(flat.y() == Approx(stage.body.ball_height).margin(1e-3));
    CHECK(stage.at("ltoes").y() == Approx(stage.body.ball_height).margin(1e-3));
    posture.leg(Side::left)[Leg::pitch] = 40 * degree;
    stage.solve(posture);
    CHECK((stage.at("lfoot") - flat).norm() < 1e-2);
    CHECK(stage.at("ltibia").y() > stage.body.ankle_height + 5);
}

TEST_CASE("knees bend forwards and elbows bring the hands to the front") {
    Stage stage;
    Posture posture = standing();
    posture[Trunk::pelvis_height] = 0.7;
    for (const Side side : both_sides) posture.arm(side)[Arm::elbow] = 90 * degree;
    stage.solve(posture);
    for (const char* knee : {"lfemur", "rfemur"}) CHECK(stage.at(knee).z() > 15);
    for (const char* hand : {"lwrist", "rwrist"}) CHECK(stage.at(hand).z() > 20);
    CHECK(stage.at("lhumerus").y() < stage.at("lclavicle").y() - 20);
}

TEST_CASE("an elbow asked to bend backwards is straight") {
    Stage stage;
    Posture posture = standing();
    const auto column =
        static_cast<size_t>(stage.skeleton.first_dof(*stage.skeleton.find("lradius")));
    for (const double asked : {-40.0, -10.0, 0.0, 5.0}) {
        posture.arm(Side::left)[Arm::elbow] = asked * degree;
        stage.solve(posture);
        CHECK(stage.dofs[column] >= 0);
        CHECK(stage.dofs[column] < 12 * degree);
    }
}

TEST_CASE("a body that turns round and round has angles that go on, without a jump") {
    Stage stage;
    const Posture posture = standing();
    TravelFrame travel;
    double last = 0;
    for (int step = 0; step < 500; ++step) {
        travel.heading = step * 2 * degree;
        stage.solve(posture, travel);
        CHECK(std::abs(stage.dofs[4] - last) < 3 * degree);
        last = stage.dofs[4];
    }
    CHECK(last == Approx(998 * degree));
}

TEST_CASE("an arm that flexes comes up in front, one that abducts at its own side") {
    Stage stage;
    Posture posture = standing();
    posture.arm(Side::left)[Arm::flexion] = 90 * degree;
    posture.arm(Side::right)[Arm::abduction] = 90 * degree;
    stage.solve(posture);
    const Eigen::Vector3d left = stage.at("lhumerus") - stage.at("lclavicle");
    const Eigen::Vector3d right = stage.at("rhumerus") - stage.at("rclavicle");
    CHECK(left.normalized().z() == Approx(1).margin(1e-6));
    CHECK(right.normalized().x() == Approx(-1).margin(1e-6));
}

TEST_CASE("a mirrored posture puts the body at the mirrored place") {
    Stage stage;
    const Posture posture = activity_posture(Activity::kick_left, usual_traits(), {0.4, 1});
    stage.solve(posture);
    const Pose own = stage.pose;
    stage.solve(mirrored(posture));
    for (const auto& [left, right] :
         {std::pair("lhand", "rhand"), std::pair("ltoes", "rtoes"), std::pair("lfemur", "rfemur"),
          std::pair("rradius", "lradius"), std::pair("head", "head")}) {
        Eigen::Vector3d expected = own.positions[static_cast<size_t>(*stage.skeleton.find(left))];
        expected.x() = -expected.x();
        INFO(left);
        CHECK((stage.at(right) - expected).norm() < 1e-3);
    }
}

TEST_CASE("a foot out of reach stretches the leg but does not break it") {
    Stage stage;
    Posture posture = standing();
    posture.leg(Side::left)[Leg::ahead] = 3;
    stage.solve(posture);
    for (const double value : stage.dofs) CHECK(std::isfinite(value));
    const Eigen::Vector3d hip = stage.at("lhipjoint");
    CHECK((stage.at("ltibia") - hip).norm() < stage.body.leg());
    CHECK((stage.at("ltibia") - hip).norm() > 0.97 * stage.body.leg());
}

TEST_CASE("the travelling frame goes where it looks and turns to the left when the rate says so") {
    TravelFrame travel;
    Posture posture;
    posture[Trunk::speed] = 2;
    travel.advance(posture, 90, 0.5);
    CHECK(travel.z == Approx(90));
    CHECK(travel.x == Approx(0).margin(1e-9));
    posture[Trunk::turn_rate] = std::numbers::pi;
    travel.advance(posture, 90, 0.5);
    travel.advance(posture, 90, 0.5);
    CHECK(travel.x == Approx(90));  // left is +x for one who faces +z
}
