#include "kinetome/features/effectors.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "clip_rows.h"
#include "kinetome/features/root_motion.h"

namespace kinetome {

MatrixF effector_positions(const Skeleton& skeleton, const MatrixFView& motion,
                           const MatrixFView& positions) {
    require_positions_of(skeleton, motion, positions);
    std::array<int, effector_roles.size()> joints{};
    std::transform(effector_roles.begin(), effector_roles.end(), joints.begin(),
                   [&](JointRole role) { return require_role(skeleton, role); });

    const RootChain chain(skeleton);
    MatrixF effectors(motion.rows(), static_cast<Eigen::Index>(3 * joints.size()));
    for (Eigen::Index i = 0; i < motion.rows(); ++i) {
        const Eigen::Matrix3d rotation = chain.pose(frame_of(motion, i)).rotation;
        const Eigen::Vector3d root = joint_position(positions, i, chain.root());
        for (size_t e = 0; e < joints.size(); ++e) {
            const Eigen::Vector3d from_root = joint_position(positions, i, joints[e]) - root;
            effectors.block<1, 3>(i, static_cast<Eigen::Index>(3 * e)) =
                (rotation.transpose() * from_root).cast<float>().transpose();
        }
    }
    return effectors;
}

MatrixF select_effectors(const MatrixFView& effectors, std::span<const JointRole> chosen) {
    if (effectors.cols() != 3 * static_cast<Eigen::Index>(effector_roles.size())) {
        throw std::invalid_argument("effectors are chosen out of all of them");
    }
    std::vector<Eigen::Index> columns;
    for (size_t e = 0; e < effector_roles.size(); ++e) {
        if (std::ranges::find(chosen, effector_roles[e]) == chosen.end()) continue;
        for (size_t axis = 0; axis < 3; ++axis) {
            columns.push_back(static_cast<Eigen::Index>(3 * e + axis));
        }
    }
    if (columns.empty() || columns.size() != 3 * chosen.size()) {
        throw std::invalid_argument("the chosen joints are not different end effectors");
    }
    return effectors(Eigen::all, columns);
}

double radius_for_effectors(double radius, size_t count) {
    return radius *
           std::sqrt(static_cast<double>(count) / static_cast<double>(effector_roles.size()));
}

MatrixF stack_neighbours(const MatrixFView& rows, int64_t offset) {
    if (offset < 0) throw std::invalid_argument("neighbours are stacked at an offset of 0 or more");
    const Eigen::Index count = rows.rows(), width = rows.cols();
    MatrixF stacked(count, 3 * width);
    for (Eigen::Index i = 0; i < count; ++i) {
        stacked.block(i, 0, 1, width) = rows.row(std::max<Eigen::Index>(i - offset, 0));
        stacked.block(i, width, 1, width) = rows.row(i);
        stacked.block(i, 2 * width, 1, width) = rows.row(std::min(i + offset, count - 1));
    }
    return stacked;
}

}  // namespace kinetome
