// Pose vectors (S1 §3.2): a frame without its place on the floor and without its heading.
#pragma once

#include <string>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/clip.h"

namespace kinetome {

/// One column of a pose vector: what it is, its unit, and the least scale standardisation gives it.
struct PoseVectorColumn {
    std::string name;  ///< "lfemur.rx", "root height", "forward velocity", …
    std::string unit;  ///< "rad", "cm", "cm/s", "rad/s"
    double floor = 0;  ///< in that unit: 5°, 1 cm, 5 cm/s, 10°/s
};

/// Columns for a class of skeletons: joint angles (all degrees of freedom but the root's), root
/// height, pitch, roll, forward and lateral velocity in the facing frame, yaw speed. 62 on CMU's
/// skeleton.
std::vector<PoseVectorColumn> pose_vector_columns(const Skeleton& skeleton);

/// frames × columns at the clip's own rate. Joint angles are unwrapped along the clip and shifted
/// by whole turns to a median in (-π, π]; velocities are central differences over `velocity_reach`
/// seconds to either side, inside the clip. The same for a clip turned about the vertical or
/// moved on the floor.
MatrixF pose_vectors(const Clip& clip, double velocity_reach = 2.0 / 120.0);

}  // namespace kinetome
