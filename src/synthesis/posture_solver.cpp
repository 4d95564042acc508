#include "kinetome/synthesis/posture_solver.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "kinetome/formats/euler.h"

namespace kinetome {
namespace {

constexpr std::array<int, 3> x_first = {0, 1, 2};
constexpr double quarter_turn = std::numbers::pi / 2;

// How bends of the trunk and the neck are shared by their three joints, lowest first.
constexpr std::array<double, 3> back_share = {0.40, 0.33, 0.27};
constexpr std::array<double, 3> neck_share = {0.35, 0.30, 0.35};

/// Bends off before a leg is straight: a knee that reaches its end at speed would pop.
double softly_limited(double distance, double leg) {
    const double free = 0.972 * leg;
    const double margin = 0.026 * leg;
    if (distance <= free) return distance;
    return free + margin * (1 - std::exp((free - distance) / margin));
}

/// The angle, but never below zero: an elbow is stopped softly before it bends backwards.
double softly_positive(double angle) {
    constexpr double soft = 12 * std::numbers::pi / 180;
    return angle >= soft ? angle : soft * std::exp((angle - soft) / soft);
}

double angle_opposite(double side, double a, double b) {
    return std::acos(std::clamp((a * a + b * b - side * side) / (2 * a * b), -1.0, 1.0));
}

}  // namespace

void TravelFrame::advance(const Posture& posture, double leg_length, double seconds) {
    const double forward = posture[Trunk::speed] * leg_length * seconds;
    const double sideways = posture[Trunk::side_speed] * leg_length * seconds;
    const double c = std::cos(heading), s = std::sin(heading);
    x += s * forward + c * sideways;
    z += c * forward - s * sideways;
    heading += posture[Trunk::turn_rate] * seconds;
}

PostureSolver::PostureSolver(const Body& body, const Skeleton& skeleton)
    : body_(body), previous_(static_cast<size_t>(skeleton.dof_count()), 0.0) {
    const auto joint = [&skeleton](const std::string& name) { return *skeleton.find(name); };
    const auto column = [&](const std::string& name) { return skeleton.first_dof(joint(name)); };
    const auto axes = [&](const std::string& name) -> Eigen::Matrix3d {
        return skeleton.joints()[static_cast<size_t>(joint(name))].axes.transpose();
    };
    back_ = {column("lowerback"), column("upperback"), column("thorax")};
    neck_ = {column("lowerneck"), column("upperneck"), column("head")};
    for (const Side side : both_sides) {
        const auto i = static_cast<size_t>(side);
        const std::string prefix = side == Side::left ? "l" : "r";
        legs_[i] = {column(prefix + "femur"), column(prefix + "tibia"), column(prefix + "foot"),
                    column(prefix + "toes")};
        arms_[i] = {column(prefix + "clavicle"), column(prefix + "humerus"),
                    column(prefix + "radius"),   column(prefix + "wrist"),
                    column(prefix + "hand"),     column(prefix + "fingers"),
                    column(prefix + "thumb")};
        femur_axes_[i] = axes(prefix + "femur");
        humerus_axes_[i] = axes(prefix + "humerus");
    }
}

void PostureSolver::solve(const Posture& posture, const TravelFrame& travel,
                          std::span<double> dofs) {
    place_root(posture, travel, dofs);
    bend_trunk(posture, dofs);
    for (const Side side : both_sides) {
        place_arm(side, posture.arm(side), dofs);
        place_leg(side, posture.leg(side), travel, dofs);
    }
    std::copy(dofs.begin(), dofs.end(), previous_.begin());
}

void PostureSolver::turn_ball(int first_dof, const Eigen::Matrix3d& rotation,
                              std::span<double> dofs) {
    const auto column = static_cast<size_t>(first_dof);
    const Eigen::Vector3d near(previous_[column], previous_[column + 1], previous_[column + 2]);
    const Eigen::Vector3d angles = euler_from_rotation(rotation, x_first, near);
    for (size_t axis = 0; axis < 3; ++axis)
        dofs[column + axis] = angles[static_cast<Eigen::Index>(axis)];
}

void PostureSolver::place_root(const Posture& posture, const TravelFrame& travel,
                               std::span<double> dofs) {
    using enum Trunk;
    const double leg = body_.leg();
    const Eigen::Vector3d local(posture[pelvis_shift] * leg,
                                posture[pelvis_height] * leg + body_.ankle_height + body_.hip_drop,
                                posture[pelvis_advance] * leg - body_.hip_front);
    root_position_ =
        Eigen::Vector3d(travel.x, 0, travel.z) + axis_rotation(1, travel.heading) * local;
    root_rotation_ = axis_rotation(1, travel.heading + posture[pelvis_yaw]) *
                     axis_rotation(0, posture[pelvis_pitch]) *
                     axis_rotation(2, posture[pelvis_roll]);
    for (size_t axis = 0; axis < 3; ++axis)
        dofs[axis] = root_position_[static_cast<Eigen::Index>(axis)];
    turn_ball(3, root_rotation_, dofs);
}

void PostureSolver::bend_trunk(const Posture& posture, std::span<double> dofs) const {
    using enum Trunk;
    for (size_t part = 0; part < 3; ++part) {
        const auto back = static_cast<size_t>(back_[part]);
        dofs[back] = back_share[part] * posture[spine_flexion];
        dofs[back + 1] = back_share[part] * posture[spine_twist];
        dofs[back + 2] = -back_share[part] * posture[spine_lean];
        const auto neck = static_cast<size_t>(neck_[part]);
        dofs[neck] = neck_share[part] * posture[neck_flexion];
        dofs[neck + 1] = neck_share[part] * posture[neck_twist];
        dofs[neck + 2] = -neck_share[part] * posture[neck_lean];
    }
}

void PostureSolver::place_arm(Side side, const ValueTable<Arm>& arm, std::span<double> dofs) {
    const auto i = static_cast<size_t>(side);
    const double sign = sign_of(side);
    const auto value = [&dofs](int column, int channel = 0) -> double& {
        return dofs[static_cast<size_t>(column + channel)];
    };
    const ArmJoints& joints = arms_[i];
    value(joints.clavicle) = -sign * arm[Arm::protraction];
    value(joints.clavicle, 1) = sign * arm[Arm::shrug];
    // The upper arm's own frame: bone along -y, elbow bending towards -z. Hanging, it is turned by
    // half a turn about the vertical, so that the elbow bends forward.
    const Eigen::Matrix3d frame = axis_rotation(0, -arm[Arm::flexion]) *
                                  axis_rotation(2, sign * arm[Arm::abduction]) *
                                  axis_rotation(1, sign * (std::numbers::pi - arm[Arm::inward]));
    turn_ball(joints.humerus, humerus_axes_[i] * frame, dofs);
    value(joints.radius) = softly_positive(arm[Arm::elbow]);
    value(joints.wrist) = -sign * arm[Arm::pronation];
    value(joints.hand) = arm[Arm::wrist_flexion];
    value(joints.hand, 1) = sign * arm[Arm::wrist_deviation];
    value(joints.fingers) = softly_positive(arm[Arm::finger_flexion]);
    value(joints.thumb) = arm[Arm::thumb_flexion];
    value(joints.thumb, 1) = sign * arm[Arm::thumb_spread];
}

void PostureSolver::place_leg(Side side, const ValueTable<Leg>& leg, const TravelFrame& travel,
                              std::span<double> dofs) {
    const auto i = static_cast<size_t>(side);
    const double sign = sign_of(side);
    const double length = body_.leg();
    const auto value = [&dofs](int column, int channel = 0) -> double& {
        return dofs[static_cast<size_t>(column + channel)];
    };

    // The ankle: over a flat sole, but carried round the ball by a raised heel.
    const double rise = body_.ankle_height - body_.ball_height;
    const double pitch = leg[Leg::pitch];
    const double heel_up = std::max(0.0, pitch);
    const double drop = rise * std::cos(heel_up) + body_.foot * std::sin(heel_up);
    const double back = body_.foot * std::cos(heel_up) - rise * std::sin(heel_up);
    const double foot_heading = travel.heading + sign * leg[Leg::toe_out];
    const Eigen::Matrix3d travel_turn = axis_rotation(1, travel.heading);
    const Eigen::Vector3d ankle =
        Eigen::Vector3d(travel.x, 0, travel.z) +
        travel_turn * Eigen::Vector3d(sign * leg[Leg::out] * length, 0, leg[Leg::ahead] * length) +
        axis_rotation(1, foot_heading) *
            Eigen::Vector3d(0, leg[Leg::lift] * length + body_.ball_height + drop,
                            body_.foot - back);

    const Eigen::Vector3d hip =
        root_position_ +
        root_rotation_ * Eigen::Vector3d(sign * body_.hip_side, -body_.hip_drop, body_.hip_front);
    const Eigen::Vector3d reach = root_rotation_.transpose() * (ankle - hip);
    const double distance = std::max(softly_limited(reach.norm(), length), 0.3 * length);
    const Eigen::Vector3d line = reach.normalized();
    const double turn = sign * leg[Leg::knee_out];
    const Eigen::Vector3d side_axis(std::cos(turn), 0, -std::sin(turn));
    const Eigen::Vector3d knee_axis = (side_axis - side_axis.dot(line) * line).normalized();
    const double hip_angle = angle_opposite(body_.shin, body_.thigh, distance);
    const double knee = std::numbers::pi - angle_opposite(distance, body_.thigh, body_.shin);
    const Eigen::Vector3d thigh = Eigen::AngleAxisd(-hip_angle, knee_axis) * line;

    Eigen::Matrix3d femur;  // own frame: bone along -y, knee's axis x
    femur.col(0) = knee_axis;
    femur.col(1) = -thigh;
    femur.col(2) = knee_axis.cross(-thigh);
    turn_ball(legs_[i].femur, femur_axes_[i] * femur, dofs);
    value(legs_[i].tibia) = knee;

    // The sole must point where the posture says: two angles, of the foot's frame under the shin.
    const Eigen::Vector3d sole(std::sin(foot_heading) * std::cos(pitch), -std::sin(pitch),
                               std::cos(foot_heading) * std::cos(pitch));
    const Eigen::Vector3d local = axis_rotation(0, quarter_turn) *
                                  (root_rotation_ * femur * axis_rotation(0, knee)).transpose() *
                                  sole;
    value(legs_[i].foot) = -std::asin(std::clamp(local.z(), -1.0, 1.0));
    value(legs_[i].foot, 1) = std::atan2(local.x(), -local.y());
    value(legs_[i].toes) = -leg[Leg::toe_bend];
}

}  // namespace kinetome
