// A body small enough to reason about: root, hips, ankles, wrists and head; it faces +z, its left
// is +x. With the default channels of the root, its rotation is Ry(ry) Rx(rx) Rz(rz).
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/clip.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/skeleton.h"

namespace small_body {

using kinetome::Channel;
using kinetome::Joint;
using kinetome::JointRole;
using kinetome::MatrixF;
using kinetome::Skeleton;

inline const std::vector<Channel> turn_last = {Channel::tx, Channel::ty, Channel::tz,
                                               Channel::rz, Channel::rx, Channel::ry};
inline const std::vector<Channel> three_angles = {Channel::rx, Channel::ry, Channel::rz};

inline Joint bone(const char* name, int parent, const Eigen::Vector3d& offset,
                  std::vector<Channel> channels) {
    Joint joint;
    joint.name = name;
    joint.parent = parent;
    joint.offset_after = offset;
    joint.channels = std::move(channels);
    return joint;
}

inline Skeleton skeleton(const std::vector<Channel>& root_channels = turn_last) {
    Skeleton body(
        "small body",
        {bone("root", -1, {0, 0, 0}, root_channels), bone("lhip", 0, {9, -5, 0}, {}),
         bone("lankle", 1, {0, -80, 2}, three_angles), bone("rhip", 0, {-9, -5, 0}, {}),
         bone("rankle", 3, {0, -80, 2}, three_angles), bone("head", 0, {0, 70, 5}, three_angles),
         bone("lwrist", 0, {60, 45, 0}, three_angles),
         bone("rwrist", 0, {-60, 45, 0}, three_angles)});
    const std::pair<JointRole, int> roles[] = {
        {JointRole::root, 0},       {JointRole::left_hip, 1},    {JointRole::left_ankle, 2},
        {JointRole::right_hip, 3},  {JointRole::right_ankle, 4}, {JointRole::head, 5},
        {JointRole::left_wrist, 6}, {JointRole::right_wrist, 7},
    };
    for (const auto& [role, joint] : roles) body.set_role(role, joint);
    return body;
}

constexpr int root_x = 0, root_y = 1, root_z = 2, root_roll = 3, root_pitch = 4, root_yaw = 5;

/// Frames of a body that wanders about and moves every joint, at 120 frames a second.
inline MatrixF wandering(int frames) {
    MatrixF motion(frames, skeleton().dof_count());
    for (int i = 0; i < frames; ++i) {
        const double t = i / 120.0;
        motion(i, root_x) = static_cast<float>(80 * std::sin(0.9 * t));
        motion(i, root_y) = static_cast<float>(95 + 4 * std::sin(5 * t));
        motion(i, root_z) = static_cast<float>(120 * t - 30 * std::cos(t));
        motion(i, root_roll) = static_cast<float>(0.2 * std::sin(3 * t));
        motion(i, root_pitch) = static_cast<float>(0.3 * std::cos(2 * t));
        motion(i, root_yaw) = static_cast<float>(1.3 * t);
        for (int dof = 6; dof < motion.cols(); ++dof)
            motion(i, dof) = static_cast<float>(0.8 * std::sin((1 + 0.3 * dof) * t + dof));
    }
    return motion;
}

/// The same motion with the floor turned by `angle` about the vertical and moved by (x, z).
inline MatrixF turned_and_moved(MatrixF motion, double angle, double x, double z) {
    for (Eigen::Index i = 0; i < motion.rows(); ++i) {
        const double from_x = double{motion(i, root_x)}, from_z = double{motion(i, root_z)};
        motion(i, root_x) =
            static_cast<float>(std::cos(angle) * from_x + std::sin(angle) * from_z + x);
        motion(i, root_z) =
            static_cast<float>(std::cos(angle) * from_z - std::sin(angle) * from_x + z);
        motion(i, root_yaw) = static_cast<float>(double{motion(i, root_yaw)} + angle);
    }
    return motion;
}

inline MatrixF positions_of(const Skeleton& body, const MatrixF& motion) {
    kinetome::Clip clip;
    clip.skeleton = std::make_shared<const Skeleton>(body);
    clip.motion = motion;
    return kinetome::joint_positions(clip);
}

}  // namespace small_body
