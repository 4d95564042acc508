// Root and other joints as seen from the floor below the body: what two bodies do in one place.
#pragma once

#include <cstdint>
#include <span>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/skeleton.h"

namespace kinetome {

/// n × 9 (1 + m), cm, for n frames of one clip: x y z of the root and of the m joints `offset`
/// frames before, then now, then as many after, indices clamped to the clip; all from the point of
/// the floor (height zero) below the root now, z the way it faces (placement_of). So they tell
/// height, tilt and travel, but not where on the floor the body is. `motion` is n × dof_count,
/// `positions` the n × 3·joint_count that joint_positions (kinematics.h) makes of it. Throws
/// std::invalid_argument when the skeleton lacks one of the joints (the message names it), the
/// shapes disagree, or the offset is negative.
MatrixF grounded_points(const Skeleton& skeleton, const MatrixFView& motion,
                        const MatrixFView& positions, std::span<const JointRole> joints,
                        int64_t offset);

}  // namespace kinetome
