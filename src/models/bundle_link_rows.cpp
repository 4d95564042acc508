#include "kinetome/models/bundle_link_rows.h"

#include <algorithm>
#include <array>

#include "kinetome/features/grounded_points.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/resample.h"
#include "kinetome/models/retarget.h"

namespace kinetome {
namespace {

constexpr std::array compared_joints = {
    JointRole::head,       JointRole::lower_neck,  JointRole::left_elbow, JointRole::right_elbow,
    JointRole::left_wrist, JointRole::right_wrist, JointRole::left_knee,  JointRole::right_knee,
    JointRole::left_ankle, JointRole::right_ankle};

constexpr int64_t offset = 1;  // row: a fifteenth of a second

}  // namespace

bool has_bundle_link_rows(const Skeleton& skeleton) {
    const std::array hips = {JointRole::left_hip, JointRole::right_hip};
    const auto known = [&](JointRole role) { return skeleton.role(role) >= 0; };
    return std::ranges::all_of(compared_joints, known) && std::ranges::all_of(hips, known);
}

MatrixF bundle_link_rows(const Clip& clip) {
    const Clip rows = resample(clip, bundle_link_rate);
    return grounded_points(*rows.skeleton, rows.motion, joint_positions(rows), compared_joints,
                           offset) /
           static_cast<float>(leg_length(*rows.skeleton));
}

}  // namespace kinetome
