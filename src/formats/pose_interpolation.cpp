#include "kinetome/formats/pose_interpolation.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "kinetome/formats/euler.h"

namespace kinetome {
namespace {

double value(std::span<const float> frame, int column) {
    return double{frame[static_cast<size_t>(column)]};
}

void set(std::span<float> frame, int column, double to) {
    frame[static_cast<size_t>(column)] = static_cast<float>(to);
}

double mix(double before, double after, double share) {
    return before + share * (after - before);
}

}  // namespace

PoseInterpolation::PoseInterpolation(const Skeleton& skeleton) {
    for (int j = 0; j < skeleton.joint_count(); ++j) {
        add_joint(skeleton.joints()[static_cast<size_t>(j)], skeleton.first_dof(j));
    }
}

void PoseInterpolation::add_joint(const Joint& joint, int first_dof) {
    std::vector<int> axes;
    Ball ball{};
    for (size_t i = 0; i < joint.channels.size(); ++i) {
        const int column = first_dof + static_cast<int>(i);
        if (!is_rotation(joint.channels[i])) {
            translations_.push_back(column);
            continue;
        }
        const int axis = axis_of(joint.channels[i]);
        axes.push_back(axis);
        ball.columns[static_cast<size_t>(axis)] = column;
    }
    if (!joint.first_rotation_acts_first) std::ranges::reverse(axes);
    if (axes.size() == 3) {
        std::ranges::copy(axes, ball.order.begin());
        balls_.push_back(ball);
        return;
    }
    for (const int axis : axes) hinges_.push_back(ball.columns[static_cast<size_t>(axis)]);
}

Eigen::Vector3d PoseInterpolation::angles_of(const Ball& ball, std::span<const float> frame) {
    return {value(frame, ball.columns[0]), value(frame, ball.columns[1]),
            value(frame, ball.columns[2])};
}

/// The joint's axes drop out: axes · slerp(A, B) · axesᵀ is the slerp of axes·A·axesᵀ and
/// axes·B·axesᵀ.
void PoseInterpolation::turn(const Ball& ball, std::span<const float> before,
                             std::span<const float> after, double share, std::span<float> between) {
    const Eigen::Vector3d first = angles_of(ball, before), last = angles_of(ball, after);
    const Eigen::Quaterniond from(rotation_from_euler(first, ball.order));
    const Eigen::Quaterniond to(rotation_from_euler(last, ball.order));
    const Eigen::Matrix3d rotation = from.slerp(share, to).toRotationMatrix();
    const Eigen::Vector3d angles =
        euler_from_rotation(rotation, ball.order, share < 0.5 ? first : last);
    for (size_t axis = 0; axis < 3; ++axis) {
        set(between, ball.columns[axis], angles[static_cast<int>(axis)]);
    }
}

void PoseInterpolation::operator()(std::span<const float> before, std::span<const float> after,
                                   double share, std::span<float> between) const {
    for (const int column : translations_) {
        set(between, column, mix(value(before, column), value(after, column), share));
    }
    for (const int column : hinges_) {
        const double from = value(before, column);
        set(between, column, mix(from, nearest_turn(value(after, column), from), share));
    }
    for (const Ball& ball : balls_) turn(ball, before, after, share, between);
}

}  // namespace kinetome
