#include "clip_rows.h"

#include <fmt/format.h>

#include <stdexcept>

namespace kinetome {

void require_motion_of(const Skeleton& skeleton, const MatrixFView& motion) {
    if (motion.cols() == skeleton.dof_count() && skeleton.joint_count() > 0) return;
    throw std::invalid_argument(fmt::format(
        "motion of {} columns given for a skeleton of {} joints and {} degrees of freedom",
        motion.cols(), skeleton.joint_count(), skeleton.dof_count()));
}

void require_positions_of(const Skeleton& skeleton, const MatrixFView& motion,
                          const MatrixFView& positions) {
    require_motion_of(skeleton, motion);
    if (positions.rows() == motion.rows() && positions.cols() == 3 * skeleton.joint_count()) return;
    throw std::invalid_argument(
        fmt::format("joint positions of {} × {} given for {} frames of {} joints", positions.rows(),
                    positions.cols(), motion.rows(), skeleton.joint_count()));
}

int require_role(const Skeleton& skeleton, JointRole role) {
    const int joint = skeleton.role(role);
    if (joint < 0)
        throw std::invalid_argument(fmt::format("skeleton '{}' has no joint for the role '{}'",
                                                skeleton.name(), joint_role_name(role)));
    return joint;
}

}  // namespace kinetome
