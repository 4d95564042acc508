// Marker sets (S2 §2): joint positions as virtual markers, place and heading removed.
#pragma once

#include <string>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/clip.h"

namespace kinetome {

/// Names of the markers, one a joint, root first.
std::vector<std::string> marker_names(const Skeleton& skeleton);

/// frames × 3·joints, cm: root at the origin, hip axis projected on the ground along x, gravity
/// along -y (methods: mode `yaw`).
MatrixF normalised_markers(const Clip& clip);

}  // namespace kinetome
