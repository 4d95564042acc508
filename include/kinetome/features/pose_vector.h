// Pose vectors (S1 §3.2): a frame without its place on the floor and without its heading.
#pragma once

#include <string>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/skeleton.h"

namespace kinetome {

/// One column of a pose vector: what it is, its unit, and the least scale standardisation gives it.
struct PoseVectorColumn {
    std::string name;  ///< "lfemur.rx", "root height", "forward velocity", …
    std::string unit;  ///< "rad", "cm", "cm/s", "rad/s"
    double floor = 0;  ///< in that unit: 5°, 1 cm, 5 cm/s, 10°/s
};

/// Columns for a class of skeletons: joint angles (every rotation channel of every joint below
/// the root), root height, pitch, roll, forward and lateral velocity in the facing frame, yaw
/// speed. 62 on CMU's skeleton. Translation channels of joints below the root are left out: files
/// that carry them repeat the skeleton's offsets there.
std::vector<PoseVectorColumn> pose_vector_columns(const Skeleton& skeleton);

/// n × columns for the n frames of one clip (`motion`: n × dof_count, cm and radians) at `rate`
/// frames a second.
///
/// The root's rotation is read as Ry(yaw) Rx(pitch) Rz(roll), whatever the order of its channels.
/// Joint angles are unwrapped along the clip and shifted by whole turns to a median within half a
/// turn of zero; pitch and roll are not unwrapped. Velocities are differences over
/// `velocity_reach` seconds (at least one frame) to either side, one-sided at the ends of the clip
/// and zero in a clip of one frame; lateral is towards +x of a root that faces +z.
/// The same, up to rounding, for a clip turned about the vertical or moved on the floor.
/// Throws std::invalid_argument when `motion` does not have the skeleton's columns or `rate` is not
/// positive.
MatrixF pose_vectors(const Skeleton& skeleton, const MatrixFView& motion, double rate,
                     double velocity_reach = 2.0 / 120.0);

}  // namespace kinetome
