#include "kinetome/features/placement.h"

#include <Eigen/Geometry>
#include <cmath>

#include "kinetome/formats/euler.h"

namespace kinetome {
namespace {

constexpr int vertical = 1;

/// A vector on the floor, turned about the vertical.
Placement turned(const Placement& placement, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {.x = c * placement.x + s * placement.z, .z = c * placement.z - s * placement.x};
}

}  // namespace

Placement placement_of(const RootPose& root) {
    const Eigen::Quaterniond rotation(root.rotation);
    return {.x = root.position.x(),
            .z = root.position.z(),
            .heading = nearest_turn(2 * std::atan2(rotation.y(), rotation.w()), 0)};
}

Placement step_between(const Placement& from, const Placement& to) {
    Placement step = turned({.x = to.x - from.x, .z = to.z - from.z}, -from.heading);
    step.heading = nearest_turn(to.heading - from.heading, 0);
    return step;
}

Placement after_step(const Placement& from, const Placement& step) {
    const Placement move = turned(step, from.heading);
    return {.x = from.x + move.x, .z = from.z + move.z, .heading = from.heading + step.heading};
}

void place(const RootChain& root, std::span<float> dofs, const Placement& placement,
           std::span<const float> near) {
    RootPose pose = root.pose(dofs);
    const double turn = placement.heading - placement_of(pose).heading;
    pose.rotation = (axis_rotation(vertical, turn) * pose.rotation).eval();
    pose.position.x() = placement.x;
    pose.position.z() = placement.z;
    root.set_pose(dofs, pose, near);
}

}  // namespace kinetome
