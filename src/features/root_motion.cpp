#include "root_motion.h"

#include <algorithm>
#include <cmath>

#include "kinetome/formats/kinematics.h"

namespace kinetome {

RootAngles root_angles(const Eigen::Matrix3d& rotation) {
    return {.yaw = std::atan2(rotation(0, 2), rotation(2, 2)),
            .pitch = -std::asin(std::clamp(rotation(1, 2), -1.0, 1.0)),
            .roll = std::atan2(rotation(1, 0), rotation(1, 1))};
}

Eigen::Matrix3d root_rotation(const Skeleton& skeleton, std::span<const float> dofs) {
    const Joint& root = skeleton.joints().front();
    return local_rotation(root, dofs.first(root.channels.size()));
}

Eigen::Vector3d root_position(const Skeleton& skeleton, std::span<const float> dofs) {
    const Joint& root = skeleton.joints().front();
    Eigen::Vector3d position =
        root.offset_before + root_rotation(skeleton, dofs) * root.offset_after;
    for (size_t i = 0; i < root.channels.size(); ++i)
        if (!is_rotation(root.channels[i])) position[axis_of(root.channels[i])] += double{dofs[i]};
    return position;
}

}  // namespace kinetome
