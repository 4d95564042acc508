#include "kinetome/models/motion_quality.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kinetome {
namespace {

Eigen::Vector3d position(const MatrixFView& positions, int64_t frame, int64_t joint) {
    return positions.row(frame).segment<3>(3 * joint).transpose().cast<double>();
}

/// The height below which a joint is for no more than that share of its frames.
double floor_height(const MatrixFView& positions, int joint, double share) {
    std::vector<float> heights;
    for (int64_t frame = 0; frame < positions.rows(); ++frame) {
        heights.push_back(positions(frame, 3 * joint + 1));
    }
    const auto rank = static_cast<int64_t>(share * static_cast<double>(heights.size()));
    std::ranges::nth_element(heights, heights.begin() + rank);
    return double{heights[static_cast<size_t>(rank)]};
}

void check(const Skeleton& skeleton, const MatrixFView& positions, double rate) {
    if (positions.cols() != 3 * skeleton.joint_count()) {
        throw std::invalid_argument("positions must have three columns a joint");
    }
    if (!(rate > 0)) throw std::invalid_argument("the rate of a motion must be positive");
}

}  // namespace

std::vector<FootContacts> foot_contacts(const Skeleton& skeleton, const MatrixFView& positions,
                                        double rate, const ContactOptions& options) {
    check(skeleton, positions, rate);
    std::vector<FootContacts> contacts(static_cast<size_t>(positions.rows()), FootContacts{});
    if (contacts.empty()) return contacts;
    const int64_t last = positions.rows() - 1;
    for (size_t foot = 0; foot < foot_roles.size(); ++foot) {
        const int joint = skeleton.role(foot_roles[foot]);
        if (joint < 0) continue;
        const double highest = floor_height(positions, joint, options.floor_share) + options.height;
        for (int64_t frame = 0; frame <= last; ++frame) {
            const int64_t before = std::max<int64_t>(frame - 1, 0),
                          after = std::min(frame + 1, last);
            const double seconds = static_cast<double>(std::max<int64_t>(after - before, 1)) / rate;
            const double speed =
                (position(positions, after, joint) - position(positions, before, joint)).norm() /
                seconds;
            contacts[static_cast<size_t>(frame)][foot] =
                position(positions, frame, joint).y() <= highest && speed <= options.speed;
        }
    }
    return contacts;
}

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

JointPeaks joint_peaks(const MatrixFView& positions, double rate) {
    JointPeaks peaks;
    for (int64_t joint = 0; 3 * joint < positions.cols(); ++joint) {
        Eigen::Vector3d last_step;
        for (int64_t frame = 1; frame < positions.rows(); ++frame) {
            const Eigen::Vector3d step =
                position(positions, frame, joint) - position(positions, frame - 1, joint);
            peaks.speed = std::max(peaks.speed, step.norm() * rate);
            if (frame > 1) {
                peaks.acceleration =
                    std::max(peaks.acceleration, (step - last_step).norm() * rate * rate);
            }
            last_step = step;
        }
    }
    return peaks;
}

JointPeaks larger(const JointPeaks& one, const JointPeaks& other) {
    return {std::max(one.speed, other.speed), std::max(one.acceleration, other.acceleration)};
}

}  // namespace kinetome
