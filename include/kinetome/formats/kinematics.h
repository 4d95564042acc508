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

/// How a degree of freedom moves its joint and those that hang on it, where a pose has them.
struct DofMotion {
    bool turns = false;     ///< else it shifts
    Eigen::Vector3d axis;   ///< of the turn, or the way of the shift: of length 1, in the world
    Eigen::Vector3d pivot;  ///< cm; a point on the axis of a turn

    /// What a unit (radian, cm) does to a joint that is there: cm a unit.
    Eigen::Vector3d at(const Eigen::Vector3d& position) const;
};

/// A skeleton made ready to be posed many times: nothing is allocated for a frame when the pose is
/// used again.
class KinematicChain {
  public:
    explicit KinematicChain(const Skeleton& skeleton);

    int joint_count() const { return static_cast<int>(links_.size()); }
    /// `dofs` has skeleton.dof_count() values (cm, radians). Computed in double.
    void evaluate(std::span<const float> dofs, Pose& pose) const { pose_links(dofs, pose, {}); }
    /// The same, and what its degrees of freedom would do to that pose; `motions` has dof_count().
    void evaluate(std::span<const float> dofs, Pose& pose, std::span<DofMotion> motions) const;

  private:
    struct Link {
        Joint joint;
        int first_dof = 0;
        bool turns = false;      ///< some channel is a rotation
        bool has_axes = false;   ///< axes are not the identity
        bool is_offset = false;  ///< offset_before or a translation moves it in its parent's frame
    };
    /// `motions` is empty when nobody asks for them.
    void pose_links(std::span<const float> dofs, Pose& pose, std::span<DofMotion> motions) const;

    std::vector<Link> links_;
    int dof_count_ = 0;
};

/// One frame, for those who need no more; `dofs` as in KinematicChain::evaluate.
Pose forward_kinematics(const Skeleton& skeleton, std::span<const float> dofs);

/// Rotation of one joint in its parent's frame: axes · rotations · axesᵀ. `dofs` are the joint's
/// own, one a channel.
Eigen::Matrix3d local_rotation(const Joint& joint, std::span<const float> dofs);

/// What the joint's translations add to its offset_before, cm; `dofs` as in local_rotation.
Eigen::Vector3d local_translation(const Joint& joint, std::span<const float> dofs);

/// Joint positions of all frames: frames × 3·joint_count, cm, x y z of joint 0 first.
MatrixF joint_positions(const Clip& clip);

}  // namespace kinetome
