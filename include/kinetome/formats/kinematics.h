// Forward kinematics: from degrees of freedom to joint positions and rotations.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/clip.h"

namespace kinetome {

/// World position and rotation of each joint in one frame.
struct Pose {
    std::vector<Eigen::Vector3d> positions;  ///< cm, Y up
    std::vector<Eigen::Matrix3d> rotations;
};

/// `dofs` has skeleton.dof_count() values (cm, radians). Computed in double.
Pose forward_kinematics(const Skeleton& skeleton, std::span<const float> dofs);

/// Rotation of one joint in its parent's frame: axes · rotations · axesᵀ.
Eigen::Matrix3d local_rotation(const Joint& joint, std::span<const float> dofs);

/// Joint positions of all frames: frames × 3·joint_count, cm, x y z of joint 0 first.
MatrixF joint_positions(const Clip& clip);

}  // namespace kinetome
