#include "root_motion.h"

#include <algorithm>
#include <cmath>

#include "kinetome/formats/kinematics.h"

namespace kinetome {

namespace {

Eigen::Vector3d translation(const Joint& joint, std::span<const float> dofs) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (size_t i = 0; i < joint.channels.size(); ++i)
        if (!is_rotation(joint.channels[i])) sum[axis_of(joint.channels[i])] += double{dofs[i]};
    return sum;
}

}  // namespace

RootChain::RootChain(const Skeleton& skeleton) : skeleton_(skeleton) {
    const int root = std::max(skeleton.role(JointRole::root), 0);
    for (int joint = root; joint >= 0; joint = skeleton.joints()[static_cast<size_t>(joint)].parent)
        joints_.push_back(joint);
    std::reverse(joints_.begin(), joints_.end());
}

bool RootChain::contains(int joint) const {
    return std::find(joints_.begin(), joints_.end(), joint) != joints_.end();
}

RootPose RootChain::pose(std::span<const float> dofs) const {
    RootPose pose{Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
    for (const int index : joints_) {
        const Joint& joint = skeleton_.joints()[static_cast<size_t>(index)];
        const auto own =
            dofs.subspan(static_cast<size_t>(skeleton_.first_dof(index)), joint.channels.size());
        pose.position += pose.rotation * (joint.offset_before + translation(joint, own));
        pose.rotation = (pose.rotation * local_rotation(joint, own)).eval();
        pose.position += pose.rotation * joint.offset_after;
    }
    return pose;
}

RootAngles root_angles(const Eigen::Matrix3d& rotation) {
    return {.yaw = std::atan2(rotation(0, 2), rotation(2, 2)),
            .pitch = -std::asin(std::clamp(rotation(1, 2), -1.0, 1.0)),
            .roll = std::atan2(rotation(1, 0), rotation(1, 1))};
}

}  // namespace kinetome
