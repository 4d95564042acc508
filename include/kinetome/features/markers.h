// Marker sets (S2 §3): joint positions as virtual markers, place and heading removed.
#pragma once

#include <string>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/skeleton.h"

namespace kinetome {

/// Names of the markers, one a joint, in the skeleton's order.
std::vector<std::string> marker_names(const Skeleton& skeleton);

/// n × 3·joint_count, cm: root at the origin, hip axis (left to right) projected on the ground
/// along +x, gravity along -y, for n frames of one clip. `motion` is n × dof_count, `positions` the
/// n × 3·joint_count that joint_positions (kinematics.h) makes of it.
/// While the hip axis is vertical it has no projection: the frame keeps the heading of the frame
/// before, the first one takes the root's yaw.
/// Throws std::invalid_argument when the skeleton lacks a hip (the message names it) or the shapes
/// disagree.
MatrixF normalised_markers(const Skeleton& skeleton, const MatrixFView& motion,
                           const MatrixFView& positions);

}  // namespace kinetome
