#include "kinetome/formats/resample.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <vector>

#include "kinetome/formats/euler.h"

namespace kinetome {
namespace {

/// The columns of a joint that turn together.
struct Ball {
    std::array<int, 3> columns;  ///< by coordinate axis
    std::array<int, 3> order;    ///< axes, the one that acts first in front
};

/// What becomes of each column between two frames.
struct Plan {
    std::vector<Ball> balls;
    std::vector<int> hinges;  ///< angles of joints with one or two rotations
    std::vector<int> translations;
};

void add_joint(Plan& plan, const Joint& joint, int first_dof) {
    std::vector<int> axes;
    Ball ball{};
    for (size_t i = 0; i < joint.channels.size(); ++i) {
        const int column = first_dof + static_cast<int>(i);
        if (!is_rotation(joint.channels[i])) {
            plan.translations.push_back(column);
            continue;
        }
        const int axis = axis_of(joint.channels[i]);
        axes.push_back(axis);
        ball.columns[static_cast<size_t>(axis)] = column;
    }
    if (!joint.first_rotation_acts_first) std::ranges::reverse(axes);
    if (axes.size() == 3) {
        std::ranges::copy(axes, ball.order.begin());
        plan.balls.push_back(ball);
        return;
    }
    for (const int axis : axes) plan.hinges.push_back(ball.columns[static_cast<size_t>(axis)]);
}

Plan plan_of(const Skeleton& skeleton) {
    Plan plan;
    for (int j = 0; j < skeleton.joint_count(); ++j) {
        add_joint(plan, skeleton.joints()[static_cast<size_t>(j)], skeleton.first_dof(j));
    }
    return plan;
}

Eigen::Vector3d angles_of(const Ball& ball, const float* frame) {
    return {frame[ball.columns[0]], frame[ball.columns[1]], frame[ball.columns[2]]};
}

/// The joint's axes drop out: axes · slerp(A, B) · axesᵀ is the slerp of axes·A·axesᵀ and
/// axes·B·axesᵀ.
void turn_ball(const Ball& ball, const float* before, const float* after, double share,
               const float* nearest_to, float* row) {
    const Eigen::Quaterniond from(rotation_from_euler(angles_of(ball, before), ball.order));
    const Eigen::Quaterniond to(rotation_from_euler(angles_of(ball, after), ball.order));
    const Eigen::Matrix3d rotation = from.slerp(share, to).toRotationMatrix();
    const Eigen::Vector3d angles =
        euler_from_rotation(rotation, ball.order, angles_of(ball, nearest_to));
    for (size_t axis = 0; axis < 3; ++axis) {
        row[ball.columns[axis]] = static_cast<float>(angles[static_cast<int>(axis)]);
    }
}

double mix(double before, double after, double share) {
    return before + share * (after - before);
}

void interpolate(const Plan& plan, const float* before, const float* after, double share,
                 float* row) {
    for (const int column : plan.translations) {
        row[column] = static_cast<float>(mix(before[column], after[column], share));
    }
    for (const int column : plan.hinges) {
        const double target = nearest_turn(after[column], before[column]);
        row[column] = static_cast<float>(mix(before[column], target, share));
    }
    // The nearer of the two frames keeps the angles on the source's own branch.
    const float* const nearest_to = share < 0.5 ? before : after;
    for (const Ball& ball : plan.balls) turn_ball(ball, before, after, share, nearest_to, row);
}

void check_rate(double rate) {
    if (rate > 0 && std::isfinite(rate)) return;
    throw std::invalid_argument("the rate of a clip must be a positive number");
}

}  // namespace

double source_frame(int64_t row, double from_rate, double to_rate) {
    return static_cast<double>(row) * from_rate / to_rate;
}

int64_t resampled_frames(int64_t frames, double from_rate, double to_rate) {
    check_rate(from_rate);
    check_rate(to_rate);
    if (frames <= 0) return 0;
    const auto last = static_cast<double>(frames - 1);
    auto rows = static_cast<int64_t>(last * to_rate / from_rate) + 1;
    // The division may have rounded to either side of a whole number.
    while (source_frame(rows, from_rate, to_rate) <= last) ++rows;
    while (source_frame(rows - 1, from_rate, to_rate) > last) --rows;
    return rows;
}

Clip sample(const Clip& clip, std::span<const double> source_frames, double rate) {
    const Plan plan = plan_of(*clip.skeleton);
    Clip result{clip.skeleton, {}, rate, clip.warnings};
    result.motion.resize(static_cast<int64_t>(source_frames.size()), clip.motion.cols());
    for (int64_t row = 0; row < result.frames(); ++row) {
        const double at = source_frames[static_cast<size_t>(row)];
        if (!(at >= 0 && at <= static_cast<double>(clip.frames() - 1))) {
            throw std::invalid_argument("a clip can be sampled inside its frames only");
        }
        const auto frame = static_cast<int64_t>(at);
        const double share = at - static_cast<double>(frame);
        if (share == 0) {
            result.motion.row(row) = clip.motion.row(frame);
        } else {
            interpolate(plan, clip.motion.row(frame).data(), clip.motion.row(frame + 1).data(),
                        share, result.motion.row(row).data());
        }
    }
    return result;
}

Clip resample(const Clip& clip, double rate) {
    check_rate(rate);
    if (rate == clip.rate) return clip;
    std::vector<double> moments(
        static_cast<size_t>(resampled_frames(clip.frames(), clip.rate, rate)));
    for (size_t row = 0; row < moments.size(); ++row) {
        moments[row] = source_frame(static_cast<int64_t>(row), clip.rate, rate);
    }
    return sample(clip, moments, rate);
}

}  // namespace kinetome
