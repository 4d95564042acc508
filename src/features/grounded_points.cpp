#include "kinetome/features/grounded_points.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "clip_rows.h"
#include "kinetome/features/placement.h"

namespace kinetome {

MatrixF grounded_points(const Skeleton& skeleton, const MatrixFView& motion,
                        const MatrixFView& positions, std::span<const JointRole> roles,
                        int64_t offset) {
    require_positions_of(skeleton, motion, positions);
    if (offset < 0) throw std::invalid_argument("points are taken at an offset of 0 or more");
    const RootChain chain(skeleton);
    std::vector<int> joints{chain.root()};
    for (const JointRole role : roles) joints.push_back(require_role(skeleton, role));

    const Eigen::Index frames = motion.rows();
    MatrixF points(frames, static_cast<Eigen::Index>(9 * joints.size()));
    for (Eigen::Index i = 0; i < frames; ++i) {
        const Placement placement = placement_of(chain.pose(frame_of(motion, i)));
        const double c = std::cos(placement.heading), s = std::sin(placement.heading);
        Eigen::Index column = 0;
        for (const Eigen::Index frame : {i - offset, i, i + offset}) {
            for (const int joint : joints) {
                Eigen::Vector3d at = joint_position(
                    positions, std::clamp<Eigen::Index>(frame, 0, frames - 1), joint);
                at -= Eigen::Vector3d(placement.x, 0, placement.z);
                points(i, column++) = static_cast<float>(c * at.x() - s * at.z());
                points(i, column++) = static_cast<float>(at.y());
                points(i, column++) = static_cast<float>(s * at.x() + c * at.z());
            }
        }
    }
    return points;
}

}  // namespace kinetome
