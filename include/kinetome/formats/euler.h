// Rotations as three angles about coordinate axes, in any order of the axes.
#pragma once

#include <Eigen/Core>
#include <array>

namespace kinetome {

/// Rotation by `angle` radians about coordinate axis 0, 1 or 2.
Eigen::Matrix3d axis_rotation(int axis, double angle);

/// angles[a] radians about each coordinate axis a; the axis order[0] acts first, order[2] last.
Eigen::Matrix3d rotation_from_euler(const Eigen::Vector3d& angles, const std::array<int, 3>& order);

/// The angles with rotation_from_euler(angles, order) == rotation that lie nearest to `near`. Of a
/// rotation whose second angle is ±90° (gimbal lock) only the sum or difference of the other two is
/// defined: the first is then taken from `near`.
Eigen::Vector3d euler_from_rotation(const Eigen::Matrix3d& rotation,
                                    const std::array<int, 3>& order, const Eigen::Vector3d& near);

/// `angle` plus the whole turns that bring it within half a turn of `near`.
double nearest_turn(double angle, double near);

}  // namespace kinetome
