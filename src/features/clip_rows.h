// The matrices of one clip, read row by row, and whether they fit its skeleton.
#pragma once

#include <Eigen/Core>
#include <span>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/skeleton.h"

namespace kinetome {

inline std::span<const float> frame_of(const MatrixFView& motion, Eigen::Index frame) {
    return {motion.data() + frame * motion.outerStride(), static_cast<size_t>(motion.cols())};
}

inline Eigen::Vector3d joint_position(const MatrixFView& positions, Eigen::Index frame, int joint) {
    return positions.block<1, 3>(frame, 3 * joint).transpose().cast<double>();
}

/// Throw std::invalid_argument when the matrices do not have the skeleton's shape.
void require_motion_of(const Skeleton& skeleton, const MatrixFView& motion);
void require_positions_of(const Skeleton& skeleton, const MatrixFView& motion,
                          const MatrixFView& positions);

/// The joint of a role; throws std::invalid_argument naming the role when there is none.
int require_role(const Skeleton& skeleton, JointRole role);

}  // namespace kinetome
