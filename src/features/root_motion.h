// The root joint in one frame: where it is, how it is turned.
#pragma once

#include <Eigen/Core>
#include <span>

#include "kinetome/formats/skeleton.h"

namespace kinetome {

/// R = Ry(yaw) Rx(pitch) Rz(roll), radians.
struct RootAngles {
    double yaw = 0;
    double pitch = 0;
    double roll = 0;
};

RootAngles root_angles(const Eigen::Matrix3d& rotation);

/// World rotation of the root; `dofs` are all values of a frame.
Eigen::Matrix3d root_rotation(const Skeleton& skeleton, std::span<const float> dofs);

/// World position of the root, cm.
Eigen::Vector3d root_position(const Skeleton& skeleton, std::span<const float> dofs);

}  // namespace kinetome
