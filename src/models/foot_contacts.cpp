#include "kinetome/models/foot_contacts.h"

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

}  // namespace

std::vector<FootContacts> foot_contacts(const Skeleton& skeleton, const MatrixFView& positions,
                                        double rate, const ContactOptions& options) {
    if (positions.cols() != 3 * skeleton.joint_count()) {
        throw std::invalid_argument("positions must have three columns a joint");
    }
    if (!(rate > 0)) throw std::invalid_argument("the rate of a motion must be positive");
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

std::vector<FootSupport> foot_support(std::span<const FootContacts> contacts, double rate,
                                      double seconds) {
    if (!(rate > 0)) throw std::invalid_argument("the rate of a motion must be positive");
    const auto frames = static_cast<int64_t>(contacts.size());
    const int64_t reach = std::llround(seconds * rate / 2);
    std::vector<FootSupport> support(contacts.size(), FootSupport{});
    for (int64_t frame = 0; frame < frames; ++frame) {
        const int64_t first = std::max<int64_t>(frame - reach, 0);
        const int64_t end = std::min(frame + reach + 1, frames);
        for (size_t foot = 0; foot < foot_roles.size(); ++foot) {
            double standing = 0;
            for (int64_t near = first; near < end; ++near) {
                standing += contacts[static_cast<size_t>(near)][foot];
            }
            support[static_cast<size_t>(frame)][foot] = standing / static_cast<double>(end - first);
        }
    }
    return support;
}

FootSupport support_at(std::span<const FootSupport> support, double moment) {
    if (support.empty()) return {};
    const int64_t last = static_cast<int64_t>(support.size()) - 1;
    return support[static_cast<size_t>(std::clamp<int64_t>(std::llround(moment), 0, last))];
}

}  // namespace kinetome
