#include "kinetome/features/joint_quaternions.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "clip_rows.h"
#include "kinetome/features/effectors.h"
#include "kinetome/formats/kinematics.h"

namespace kinetome {
namespace {

bool turns(const Joint& joint) {
    return std::any_of(joint.channels.begin(), joint.channels.end(), is_rotation);
}

}  // namespace

std::vector<int> limb_joints(const Skeleton& skeleton) {
    const auto& joints = skeleton.joints();
    std::vector<char> carries(joints.size(), false);
    for (const JointRole role : effector_roles) {
        for (int j = require_role(skeleton, role); j >= 0; j = joints[size_t(j)].parent) {
            carries[static_cast<size_t>(j)] = true;
        }
    }
    for (int j = std::max(skeleton.role(JointRole::root), 0); j >= 0;
         j = joints[size_t(j)].parent) {
        carries[static_cast<size_t>(j)] = false;
    }
    std::vector<int> limbs;
    for (int j = 0; j < skeleton.joint_count(); ++j) {
        if (carries[static_cast<size_t>(j)] && turns(joints[size_t(j)])) limbs.push_back(j);
    }
    return limbs;
}

MatrixF joint_quaternions(const Skeleton& skeleton, const MatrixFView& motion) {
    require_motion_of(skeleton, motion);
    const std::vector<int> limbs = limb_joints(skeleton);
    MatrixF quaternions(motion.rows(), static_cast<Eigen::Index>(4 * limbs.size()));
    std::vector<Eigen::Quaterniond> before(limbs.size(), Eigen::Quaterniond::Identity());
    for (Eigen::Index i = 0; i < motion.rows(); ++i) {
        const auto dofs = frame_of(motion, i);
        for (size_t l = 0; l < limbs.size(); ++l) {
            const Joint& joint = skeleton.joints()[static_cast<size_t>(limbs[l])];
            const auto first = static_cast<size_t>(skeleton.first_dof(limbs[l]));
            Eigen::Quaterniond turn(
                local_rotation(joint, dofs.subspan(first, joint.channels.size())));
            if (turn.dot(before[l]) < 0) turn.coeffs() *= -1;
            before[l] = turn;
            quaternions.block<1, 4>(i, static_cast<Eigen::Index>(4 * l)) =
                Eigen::RowVector4d(turn.w(), turn.x(), turn.y(), turn.z()).cast<float>();
        }
    }
    return quaternions;
}

}  // namespace kinetome
