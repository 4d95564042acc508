// How the joints that carry head, hands and feet are turned, as unit quaternions.
#pragma once

#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/skeleton.h"

namespace kinetome {

/// The joints that turn on the ways from the root to the end effectors (effectors.h), the root
/// itself left out, in the order of the skeleton. Fingers, toes and what else hangs there are not
/// among them. Throws std::invalid_argument when the skeleton lacks an end effector.
std::vector<int> limb_joints(const Skeleton& skeleton);

/// n × 4j: w x y z of the rotation of each of the j limb_joints in its parent's frame. Of q and -q
/// a clip's first frame has the one with w ≥ 0, each other the one nearer to the frame before.
/// Throws std::invalid_argument when `motion` is not n × dof_count.
MatrixF joint_quaternions(const Skeleton& skeleton, const MatrixFView& motion);

}  // namespace kinetome
