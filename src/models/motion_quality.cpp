#include "kinetome/models/motion_quality.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kinetome/features/markers.h"
#include "kinetome/formats/kinematics.h"

namespace kinetome {
namespace {

Eigen::Vector3d position(const MatrixFView& positions, int64_t frame, int64_t joint) {
    return positions.row(frame).segment<3>(3 * joint).transpose().cast<double>();
}

void check(const Skeleton& skeleton, const MatrixFView& positions, double rate) {
    if (positions.cols() != 3 * skeleton.joint_count()) {
        throw std::invalid_argument("positions must have three columns a joint");
    }
    if (!(rate > 0)) throw std::invalid_argument("the rate of a motion must be positive");
}

}  // namespace

FootSlide& FootSlide::operator+=(const FootSlide& other) {
    distance += other.distance;
    seconds += other.seconds;
    return *this;
}

FootSlide foot_slide(const Skeleton& skeleton, const MatrixFView& positions,
                     std::span<const FootContacts> contacts, double rate) {
    check(skeleton, positions, rate);
    if (contacts.size() != static_cast<size_t>(positions.rows())) {
        throw std::invalid_argument("foot contacts must be given for each frame");
    }
    FootSlide slide;
    for (int64_t frame = 1; frame < positions.rows(); ++frame) {
        for (size_t foot = 0; foot < foot_roles.size(); ++foot) {
            const auto row = static_cast<size_t>(frame);
            if (!contacts[row][foot] || !contacts[row - 1][foot]) continue;
            const int joint = skeleton.role(foot_roles[foot]);
            const Eigen::Vector3d step =
                position(positions, frame, joint) - position(positions, frame - 1, joint);
            slide.distance += std::hypot(step.x(), step.z());
            slide.seconds += 1 / rate;
        }
    }
    return slide;
}

std::vector<JointPeaks> joint_peaks_by_frame(const MatrixFView& positions, double rate) {
    std::vector<JointPeaks> peaks(static_cast<size_t>(positions.rows()));
    for (int64_t joint = 0; 3 * joint < positions.cols(); ++joint) {
        Eigen::Vector3d last_step;
        for (int64_t frame = 1; frame < positions.rows(); ++frame) {
            JointPeaks& here = peaks[static_cast<size_t>(frame)];
            const Eigen::Vector3d step =
                position(positions, frame, joint) - position(positions, frame - 1, joint);
            here.speed = std::max(here.speed, step.norm() * rate);
            if (frame > 1) {
                here.acceleration =
                    std::max(here.acceleration, (step - last_step).norm() * rate * rate);
            }
            last_step = step;
        }
    }
    return peaks;
}

JointPeaks joint_peaks(const MatrixFView& positions, double rate) {
    JointPeaks peaks;
    for (const JointPeaks& one : joint_peaks_by_frame(positions, rate)) peaks = larger(peaks, one);
    return peaks;
}

std::vector<double> pose_steps(const Clip& clip) {
    return pose_steps(clip, joint_positions(clip));
}

std::vector<double> pose_steps(const Clip& clip, const MatrixFView& positions) {
    const MatrixF markers = normalised_markers(*clip.skeleton, clip.motion, positions);
    const double joints = static_cast<double>(markers.cols()) / 3;
    std::vector<double> steps;
    for (int64_t frame = 1; frame < markers.rows(); ++frame) {
        const float squares = (markers.row(frame) - markers.row(frame - 1)).squaredNorm();
        steps.push_back(std::sqrt(static_cast<double>(squares) / joints) * clip.rate);
    }
    return steps;
}

double largest_step(std::span<const double> pose_steps, const MotionRun& run) {
    const auto count = static_cast<double>(pose_steps.size());
    const auto first = static_cast<size_t>(std::clamp(std::floor(run.first), 0.0, count));
    const auto end = static_cast<size_t>(std::clamp(std::ceil(run.end) - 1, 0.0, count));
    double largest = 0;
    for (size_t i = first; i < end; ++i) largest = std::max(largest, pose_steps[i]);
    return largest;
}

JointPeaks larger(const JointPeaks& one, const JointPeaks& other) {
    return {std::max(one.speed, other.speed), std::max(one.acceleration, other.acceleration)};
}

}  // namespace kinetome
