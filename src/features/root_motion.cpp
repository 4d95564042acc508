#include "kinetome/features/root_motion.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <stdexcept>

#include "kinetome/formats/euler.h"
#include "kinetome/formats/kinematics.h"

namespace kinetome {

namespace {

/// The values of one joint among those of a frame.
template <class Value>
std::span<Value> own_dofs(const Skeleton& skeleton, int joint, std::span<Value> dofs) {
    const auto& channels = skeleton.joints()[static_cast<size_t>(joint)].channels;
    return dofs.subspan(static_cast<size_t>(skeleton.first_dof(joint)), channels.size());
}

/// Channel values that turn and move a joint with three translations and three rotations so.
void set_joint(const Joint& joint, std::span<float> dofs, const Eigen::Vector3d& translation,
               const Eigen::Matrix3d& rotation, std::span<const float> near) {
    std::array<int, 3> order{};
    Eigen::Vector3d near_angles;
    size_t rotations = 0;
    for (size_t i = 0; i < joint.channels.size(); ++i) {
        if (!is_rotation(joint.channels[i])) continue;
        order[rotations++] = axis_of(joint.channels[i]);
        near_angles[axis_of(joint.channels[i])] = double{near[i]};
    }
    if (!joint.first_rotation_acts_first) std::ranges::reverse(order);
    const Eigen::Vector3d angles =
        euler_from_rotation(joint.axes.transpose() * rotation * joint.axes, order, near_angles);
    for (size_t i = 0; i < joint.channels.size(); ++i) {
        const Eigen::Vector3d& values = is_rotation(joint.channels[i]) ? angles : translation;
        dofs[i] = static_cast<float>(values[axis_of(joint.channels[i])]);
    }
}

}  // namespace

RootChain::RootChain(const Skeleton& skeleton) : skeleton_(skeleton) {
    const int root = std::max(skeleton.role(JointRole::root), 0);
    for (int index = root; index >= 0; index = joint(index).parent) joints_.push_back(index);
    std::reverse(joints_.begin(), joints_.end());
}

bool RootChain::contains(int joint) const {
    return std::find(joints_.begin(), joints_.end(), joint) != joints_.end();
}

RootPose RootChain::pose(std::span<const float> dofs) const {
    RootPose pose{Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
    for (const int index : joints_) {
        const auto own = own_dofs(skeleton_, index, dofs);
        pose.position +=
            pose.rotation * (joint(index).offset_before + local_translation(joint(index), own));
        pose.rotation = (pose.rotation * local_rotation(joint(index), own)).eval();
        pose.position += pose.rotation * joint(index).offset_after;
    }
    return pose;
}

bool RootChain::is_free() const {
    std::bitset<6> channels;
    for (const Channel channel : joint(root()).channels) channels.set(static_cast<size_t>(channel));
    return channels.all();
}

void RootChain::set_pose(std::span<float> dofs, const RootPose& pose,
                         std::span<const float> near) const {
    if (!is_free()) {
        throw std::invalid_argument("joint '" + joint(root()).name + "' of skeleton '" +
                                    skeleton_.name() +
                                    "' lacks the three translations and three "
                                    "rotations that a root needs to be put anywhere");
    }
    Eigen::Vector3d parent = Eigen::Vector3d::Zero();
    for (const int index : joints_) {
        if (index == root()) break;
        std::ranges::fill(own_dofs(skeleton_, index, dofs), 0.0f);
        parent += joint(index).offset_before + joint(index).offset_after;
    }
    const Joint& own = joint(root());
    const Eigen::Vector3d translation =
        pose.position - pose.rotation * own.offset_after - parent - own.offset_before;
    set_joint(own, own_dofs(skeleton_, root(), dofs), translation, pose.rotation,
              own_dofs(skeleton_, root(), near));
}

RootAngles root_angles(const Eigen::Matrix3d& rotation) {
    return {.yaw = std::atan2(rotation(0, 2), rotation(2, 2)),
            .pitch = -std::asin(std::clamp(rotation(1, 2), -1.0, 1.0)),
            .roll = std::atan2(rotation(1, 0), rotation(1, 1))};
}

}  // namespace kinetome
