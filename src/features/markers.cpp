#include "kinetome/features/markers.h"

#include <cmath>

#include "clip_rows.h"
#include "kinetome/features/root_motion.h"

namespace kinetome {

namespace {

/// Least share of the hip axis that must lie along the ground for it to give a heading.
constexpr double least_ground_share = 1e-3;

/// A direction on the ground, of unit length: where the body's right is.
struct GroundDirection {
    double x = 1;
    double z = 0;
};

/// The right of a root that faces +z at yaw 0.
GroundDirection right_of_root(const RootPose& root) {
    const double yaw = root_angles(root.rotation).yaw;
    return {.x = -std::cos(yaw), .z = std::sin(yaw)};
}

}  // namespace

std::vector<std::string> marker_names(const Skeleton& skeleton) {
    std::vector<std::string> names;
    for (const Joint& joint : skeleton.joints()) names.push_back(joint.name);
    return names;
}

MatrixF normalised_markers(const Skeleton& skeleton, const MatrixFView& motion,
                           const MatrixFView& positions) {
    require_positions_of(skeleton, motion, positions);
    const int left_hip = require_role(skeleton, JointRole::left_hip);
    const int right_hip = require_role(skeleton, JointRole::right_hip);

    const RootChain chain(skeleton);
    MatrixF markers(positions.rows(), positions.cols());
    if (positions.rows() == 0) return markers;
    GroundDirection right = right_of_root(chain.pose(frame_of(motion, 0)));
    for (Eigen::Index i = 0; i < positions.rows(); ++i) {
        const Eigen::Vector3d axis =
            joint_position(positions, i, right_hip) - joint_position(positions, i, left_hip);
        const double along_ground = std::hypot(axis.x(), axis.z());
        if (along_ground > least_ground_share * axis.norm())
            right = {.x = axis.x() / along_ground, .z = axis.z() / along_ground};

        const Eigen::Vector3d root = joint_position(positions, i, chain.root());
        for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
            const Eigen::Vector3d from_root = joint_position(positions, i, joint) - root;
            markers(i, 3 * joint) =
                static_cast<float>(right.x * from_root.x() + right.z * from_root.z());
            markers(i, 3 * joint + 1) = static_cast<float>(from_root.y());
            markers(i, 3 * joint + 2) =
                static_cast<float>(right.x * from_root.z() - right.z * from_root.x());
        }
    }
    return markers;
}

}  // namespace kinetome
