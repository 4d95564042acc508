// The root joint in one frame: where it is, how it is turned.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "kinetome/formats/skeleton.h"

namespace kinetome {

/// World position (cm) and rotation of the root.
struct RootPose {
    Eigen::Vector3d position;
    Eigen::Matrix3d rotation;
};

/// The joint of the role `root` (joint 0 without such a role) and the joints above it, which some
/// rigs have: a reference on the floor, say. Keeps a reference to the skeleton.
class RootChain {
  public:
    explicit RootChain(const Skeleton& skeleton);

    int root() const { return joints_.back(); }
    bool contains(int joint) const;
    /// `dofs` are all values of a frame.
    RootPose pose(std::span<const float> dofs) const;

    /// Whether the root itself has three translations and three rotations: any pose can be set.
    bool is_free() const;
    /// Puts the root there: joints above it are set to zero, its own angles to those nearest to the
    /// ones of `near`, a frame too, which may be `dofs`. Throws std::invalid_argument when the root
    /// is not free.
    void set_pose(std::span<float> dofs, const RootPose& pose, std::span<const float> near) const;

  private:
    const Joint& joint(int index) const { return skeleton_.joints()[static_cast<size_t>(index)]; }

    const Skeleton& skeleton_;
    std::vector<int> joints_;  ///< topmost first
};

/// R = Ry(yaw) Rx(pitch) Rz(roll), radians.
struct RootAngles {
    double yaw = 0;
    double pitch = 0;
    double roll = 0;
};

RootAngles root_angles(const Eigen::Matrix3d& rotation);

}  // namespace kinetome
