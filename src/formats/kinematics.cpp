#include "kinetome/formats/kinematics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kinetome {
namespace {

/// matrix · (rotation by `angle` about coordinate axis `axis`), in place: it mixes two columns.
void turn_about(Eigen::Matrix3d& matrix, int axis, double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (int row = 0; row < 3; ++row) {
        const double before_u = matrix(row, u);
        const double before_v = matrix(row, v);
        matrix(row, u) = c * before_u + s * before_v;
        matrix(row, v) = c * before_v - s * before_u;
    }
}

/// matrix · (product of the rotations among the joint's channels). The rotation that acts last
/// stands leftmost in the product, so it is the first to be multiplied from the right. `motions`
/// is null, or gets the axes of the turns, one a channel.
void turn_by_channels(Eigen::Matrix3d& matrix, const Joint& joint, const float* dofs,
                      DofMotion* motions = nullptr) {
    const std::vector<Channel>& channels = joint.channels;
    for (size_t step = 0; step < channels.size(); ++step) {
        const size_t i = joint.first_rotation_acts_first ? channels.size() - 1 - step : step;
        if (!is_rotation(channels[i])) continue;
        if (motions) motions[i].axis = matrix.col(axis_of(channels[i]));
        turn_about(matrix, axis_of(channels[i]), static_cast<double>(dofs[i]));
    }
}

void shift_by_channels(const Eigen::Matrix3d& parent_rotation, const Joint& joint,
                       DofMotion* motions) {
    for (size_t i = 0; i < joint.channels.size(); ++i) {
        motions[i].turns = is_rotation(joint.channels[i]);
        if (motions[i].turns) continue;
        motions[i].axis = parent_rotation.col(axis_of(joint.channels[i]));
    }
}

}  // namespace

Eigen::Vector3d DofMotion::at(const Eigen::Vector3d& position) const {
    if (!turns) return axis;
    return axis.cross(position - pivot);
}

KinematicChain::KinematicChain(const Skeleton& skeleton) : dof_count_(skeleton.dof_count()) {
    links_.reserve(skeleton.joints().size());
    for (int j = 0; j < skeleton.joint_count(); ++j) {
        const Joint& joint = skeleton.joints()[static_cast<size_t>(j)];
        const bool turns = std::ranges::any_of(joint.channels, is_rotation);
        const bool moves = !std::ranges::all_of(joint.channels, is_rotation);
        links_.push_back({.joint = joint,
                          .first_dof = skeleton.first_dof(j),
                          .turns = turns,
                          .has_axes = joint.axes != Eigen::Matrix3d::Identity(),
                          .is_offset = moves || joint.offset_before != Eigen::Vector3d::Zero()});
    }
}

void KinematicChain::evaluate(std::span<const float> dofs, Pose& pose,
                              std::span<DofMotion> motions) const {
    if (motions.size() != static_cast<size_t>(dof_count_)) {
        throw std::invalid_argument("there is one motion a degree of freedom");
    }
    pose_links(dofs, pose, motions);
}

void KinematicChain::pose_links(std::span<const float> dofs, Pose& pose,
                                std::span<DofMotion> motions) const {
    if (dofs.size() != static_cast<size_t>(dof_count_)) {
        throw std::invalid_argument("a frame must have one value a degree of freedom");
    }
    pose.positions.resize(links_.size());
    pose.rotations.resize(links_.size());
    for (size_t j = 0; j < links_.size(); ++j) {
        const Link& link = links_[j];
        const Joint& joint = link.joint;
        const float* const own = dofs.data() + link.first_dof;
        DofMotion* const moves = motions.empty() ? nullptr : motions.data() + link.first_dof;
        Eigen::Vector3d& position = pose.positions[j];
        Eigen::Matrix3d& rotation = pose.rotations[j];

        position.setZero();
        rotation.setIdentity();
        if (joint.parent >= 0) {
            position = pose.positions[static_cast<size_t>(joint.parent)];
            rotation = pose.rotations[static_cast<size_t>(joint.parent)];
        }
        if (moves) shift_by_channels(rotation, joint, moves);
        if (link.is_offset) {
            position += rotation * (joint.offset_before +
                                    local_translation(joint, {own, joint.channels.size()}));
        }
        if (link.turns) {
            if (link.has_axes) rotation = (rotation * joint.axes).eval();
            turn_by_channels(rotation, joint, own, moves);
            if (link.has_axes) rotation = (rotation * joint.axes.transpose()).eval();
        }
        if (moves) {
            for (size_t i = 0; i < joint.channels.size(); ++i) moves[i].pivot = position;
        }
        position += rotation * joint.offset_after;
    }
}

Pose forward_kinematics(const Skeleton& skeleton, std::span<const float> dofs) {
    Pose pose;
    KinematicChain(skeleton).evaluate(dofs, pose);
    return pose;
}

Eigen::Matrix3d local_rotation(const Joint& joint, std::span<const float> dofs) {
    if (dofs.size() != joint.channels.size()) {
        throw std::invalid_argument("a joint must have one value a channel");
    }
    Eigen::Matrix3d rotation = joint.axes;
    turn_by_channels(rotation, joint, dofs.data());
    return rotation * joint.axes.transpose();
}

Eigen::Vector3d local_translation(const Joint& joint, std::span<const float> dofs) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (size_t i = 0; i < joint.channels.size(); ++i) {
        if (is_rotation(joint.channels[i])) continue;
        sum[axis_of(joint.channels[i])] += static_cast<double>(dofs[i]);
    }
    return sum;
}

MatrixF joint_positions(const Clip& clip) {
    const KinematicChain chain(*clip.skeleton);
    const auto dof_count = static_cast<size_t>(clip.motion.cols());
    MatrixF positions(clip.frames(), 3 * chain.joint_count());
    Pose pose;
    for (int64_t frame = 0; frame < clip.frames(); ++frame) {
        chain.evaluate({clip.motion.row(frame).data(), dof_count}, pose);
        for (int joint = 0; joint < chain.joint_count(); ++joint) {
            positions.row(frame).segment<3>(3 * joint) =
                pose.positions[static_cast<size_t>(joint)].transpose().cast<float>();
        }
    }
    return positions;
}

}  // namespace kinetome
