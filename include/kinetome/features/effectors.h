// End-effector features (S3 §3): where head, hands and feet are, seen from the root.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/skeleton.h"

namespace kinetome {

/// The end effectors, in the order of their columns.
inline constexpr std::array effector_roles = {JointRole::head, JointRole::left_wrist,
                                              JointRole::right_wrist, JointRole::left_ankle,
                                              JointRole::right_ankle};

/// n × 15, cm: x y z of each end effector in the root's own frame, Rᵀ(p - p_root) with the full
/// root rotation R, for n frames of one clip. `motion` is n × dof_count, `positions` the n ×
/// 3·joint_count that joint_positions (kinematics.h) makes of it. Throws std::invalid_argument when
/// the skeleton lacks one of effector_roles (the message names it) or the shapes disagree.
MatrixF effector_positions(const Skeleton& skeleton, const MatrixFView& motion,
                           const MatrixFView& positions);

/// n × 3m: the columns of m of the effectors, out of the n × 15 of all, in the order of
/// effector_roles. Throws std::invalid_argument for another shape, none or one that is no effector.
MatrixF select_effectors(const MatrixFView& effectors, std::span<const JointRole> chosen);

/// The radius for m effectors that allows each of them the distance that `radius` allows each of
/// all five: squared distances add up over effectors, so that it is radius · √(m / 5).
double radius_for_effectors(double radius, size_t count);

/// n × 3d: before each row the one `offset` rows earlier, after it the one `offset` rows later,
/// indices clamped to the clip (S3 §3: F45 at 30 Hz from rows of 15).
MatrixF stack_neighbours(const MatrixFView& rows, int64_t offset = 1);

}  // namespace kinetome
