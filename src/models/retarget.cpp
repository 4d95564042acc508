#include "kinetome/models/retarget.h"

#include <stdexcept>
#include <utility>

#include "kinetome/features/root_motion.h"

namespace kinetome {
namespace {

[[noreturn]] void refuse_legless(const Skeleton& skeleton) {
    throw std::invalid_argument("skeleton '" + skeleton.name() +
                                "' has no leg: its hips or ankles are not known");
}

double length_between(const Skeleton& skeleton, JointRole upper, JointRole lower) {
    const int hip = skeleton.role(upper);
    if (hip < 0) refuse_legless(skeleton);
    double length = 0;
    for (int joint = skeleton.role(lower); joint != hip;) {
        if (joint < 0) refuse_legless(skeleton);
        const Joint& bone = skeleton.joints()[static_cast<size_t>(joint)];
        length += bone.offset_before.norm() + bone.offset_after.norm();
        joint = bone.parent;
    }
    return length;
}

}  // namespace

double leg_length(const Skeleton& skeleton) {
    return (length_between(skeleton, JointRole::left_hip, JointRole::left_ankle) +
            length_between(skeleton, JointRole::right_hip, JointRole::right_ankle)) /
           2;
}

Clip retarget(const Clip& clip, std::shared_ptr<const Skeleton> skeleton) {
    if (clip.skeleton == skeleton) return clip;
    if (clip.skeleton->class_name() != skeleton->class_name()) {
        throw std::invalid_argument("skeletons '" + clip.skeleton->name() + "' and '" +
                                    skeleton->name() + "' are of different classes");
    }
    const double scale = leg_length(*skeleton) / leg_length(*clip.skeleton);
    const RootChain from(*clip.skeleton), to(*skeleton);
    Clip result = clip;
    result.skeleton = std::move(skeleton);
    const auto dof_count = static_cast<size_t>(clip.motion.cols());
    for (int64_t frame = 0; frame < result.frames(); ++frame) {
        const std::span<float> dofs{result.motion.row(frame).data(), dof_count};
        RootPose pose = from.pose(dofs);
        pose.position *= scale;
        to.set_pose(dofs, pose, dofs);
    }
    return result;
}

}  // namespace kinetome
