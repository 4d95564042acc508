#include "kinetome/models/motion_blend.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "registration.h"

namespace kinetome {
namespace {

std::span<const float> frame_of(const Clip& clip, int64_t frame) {
    return {clip.motion.row(frame).data(), static_cast<size_t>(clip.motion.cols())};
}

Placement scaled(const Placement& step, double by) {
    return {.x = by * step.x, .z = by * step.z, .heading = by * step.heading};
}

double total_weight(std::span<const MotionShare> shares) {
    double total = 0;
    for (const MotionShare& share : shares) total += share.weight;
    return total;
}

}  // namespace

MotionBlend::MotionBlend(std::shared_ptr<const Skeleton> skeleton, double rate)
    : skeleton_(std::move(skeleton)),
      rate_(rate),
      root_(*skeleton_),
      chain_(*skeleton_),
      interpolate_(*skeleton_) {
    if (!root_.is_free()) {
        throw std::invalid_argument("motion of skeleton '" + skeleton_->name() +
                                    "' cannot be joined: its root lacks translations or rotations");
    }
}

void MotionBlend::check(std::span<const MotionShare> shares) const {
    for (const MotionShare& share : shares) {
        if (share.clip->frames() == 0 || share.clip->motion.cols() != skeleton_->dof_count()) {
            throw std::invalid_argument("a clip to be blended has no frames or another skeleton");
        }
        if (!std::isfinite(share.moment) || !std::isfinite(share.moment_before)) {
            throw std::invalid_argument("the moments of a blend must be finite");
        }
        if (!(share.weight >= 0)) throw std::invalid_argument("a weight of a blend is negative");
    }
    const double total = total_weight(shares);
    if (!(total > 0) || !std::isfinite(total)) {
        throw std::invalid_argument("the weights of a blend must have a sum above zero");
    }
}

MotionBlend::Row MotionBlend::centred_pose(const Clip& clip, double moment) const {
    const double inside = std::clamp(moment, 0.0, static_cast<double>(clip.frames() - 1));
    const auto frame = static_cast<int64_t>(inside);
    const double share = inside - static_cast<double>(frame);
    const auto centred = [&](int64_t at) {
        const auto dofs = frame_of(clip, at);
        Row row(dofs.begin(), dofs.end());
        place(root_, row, {}, row);
        return row;
    };
    Row row = centred(frame);
    if (share > 0) interpolate_(row, centred(frame + 1), share, row);
    return row;
}

Placement MotionBlend::placement(const Clip& clip, double moment) const {
    const auto at = [&](int64_t frame) { return placement_of(root_.pose(frame_of(clip, frame))); };
    if (clip.frames() == 1) return at(0);
    const double whole =
        std::clamp(std::floor(moment), 0.0, static_cast<double>(clip.frames() - 2));
    const auto frame = static_cast<int64_t>(whole);
    return after_step(at(frame), scaled(step_between(at(frame), at(frame + 1)), moment - whole));
}

MotionBlend::Feet MotionBlend::feet(const Row& centred, const Placement& placement) const {
    Row placed = centred;
    place(root_, placed, placement, centred);
    Pose pose;
    chain_.evaluate(placed, pose);
    Feet feet;
    for (size_t foot = 0; foot < feet.size(); ++foot) {
        const int joint = skeleton_->role(foot_roles[foot]);
        feet[foot] =
            joint < 0 ? Eigen::Vector3d::Zero() : pose.positions[static_cast<size_t>(joint)];
    }
    return feet;
}

Eigen::Vector3d MotionBlend::slide(std::span<const MotionShare> shares, const Row& pose,
                                   const Placement& step) const {
    FootSupport support = {};
    const double total = total_weight(shares);
    for (const MotionShare& share : shares) {
        if (share.weight == total) return Eigen::Vector3d::Zero();
        for (size_t foot = 0; foot < support.size(); ++foot) {
            support[foot] += share.weight / total * share.support[foot];
        }
    }
    const double standing = std::reduce(support.begin(), support.end());
    if (standing == 0) return Eigen::Vector3d::Zero();
    Row before = rows_.back();
    place(root_, before, {}, before);
    const Feet from = feet(before, {}), to = feet(pose, step);
    Feet beyond;
    for (size_t foot = 0; foot < beyond.size(); ++foot) beyond[foot] = to[foot] - from[foot];
    for (const MotionShare& share : shares) {
        if (share.weight == 0) continue;
        const Placement own = step_between(placement(*share.clip, share.moment_before),
                                           placement(*share.clip, share.moment));
        const Feet own_from = feet(centred_pose(*share.clip, share.moment_before), {});
        const Feet own_to = feet(centred_pose(*share.clip, share.moment), own);
        for (size_t foot = 0; foot < beyond.size(); ++foot) {
            beyond[foot] -= share.weight / total * (own_to[foot] - own_from[foot]);
        }
    }
    Eigen::Vector3d slid = Eigen::Vector3d::Zero();
    for (size_t foot = 0; foot < beyond.size(); ++foot) slid += support[foot] * beyond[foot];
    return slid / std::max(standing, 1.0);
}

void MotionBlend::append(std::span<const MotionShare> shares) {
    check(shares);
    Row row;
    Placement step;
    double weight = 0;  // of the shares that row blends
    for (const MotionShare& share : shares) {
        if (share.weight == 0) continue;
        weight += share.weight;
        Row pose = centred_pose(*share.clip, share.moment);
        if (row.empty()) {
            row = std::move(pose);
        } else {
            interpolate_(row, pose, share.weight / weight, row);
        }
        const Placement own = scaled(step_between(placement(*share.clip, share.moment_before),
                                                  placement(*share.clip, share.moment)),
                                     share.weight);
        step = {step.x + own.x, step.z + own.z, step.heading + own.heading};
    }
    step = scaled(step, 1 / weight);
    if (rows_.empty()) {
        placement_ = placement(*shares.front().clip, shares.front().moment);
    } else {
        const Eigen::Vector3d slid = slide(shares, row, step);
        step.x -= slid.x();
        step.z -= slid.z();
        placement_ = after_step(placement_, step);
    }
    const Row near = rows_.empty() ? row : rows_.back();
    place(root_, row, placement_, near);
    rows_.push_back(std::move(row));
}

Clip MotionBlend::clip() const {
    Clip clip{skeleton_, {}, rate_};
    clip.motion.resize(frames(), skeleton_->dof_count());
    for (int64_t frame = 0; frame < frames(); ++frame) {
        std::ranges::copy(rows_[static_cast<size_t>(frame)], clip.motion.row(frame).data());
    }
    return clip;
}

namespace {

double moment_of(const BlendPart& part, double share) {
    const auto length = static_cast<double>(part.end - part.first);
    return static_cast<double>(part.first) + length * registered_share(part.registration, share);
}

/// Parts as one: what share of what they are registered to is passed after so many frames.
class BlendTime {
  public:
    explicit BlendTime(std::span<const BlendPart> parts) : parts_(parts) {
        for (const BlendPart& part : parts) total_ += part.weight;
    }

    double frames(double share) const {
        double sum = 0;
        for (const BlendPart& part : parts_) {
            sum += part.weight * (moment_of(part, share) - static_cast<double>(part.first));
        }
        return sum / total_;
    }
    /// By bisection: frames ascend with the share.
    double share(double frames) const {
        double low = 0, high = 1;
        for (int i = 0; i < 52; ++i) {
            const double middle = (low + high) / 2;
            (this->frames(middle) <= frames ? low : high) = middle;
        }
        return low;
    }

  private:
    std::span<const BlendPart> parts_;
    double total_ = 0;
};

void check(std::span<const BlendPart> parts) {
    if (parts.empty()) throw std::invalid_argument("there is nothing to blend");
    for (const BlendPart& part : parts) {
        if (part.clip->rate != parts.front().clip->rate) {
            throw std::invalid_argument("motions to be blended must have one rate");
        }
        check_registration(part.registration);
    }
}

}  // namespace

Clip blend_motions(std::span<const BlendPart> parts) {
    check(parts);
    MotionBlend blend(parts.front().clip->skeleton, parts.front().clip->rate);
    const BlendTime time(parts);
    const double whole = time.frames(1), length = std::max(1.0, std::nearbyint(whole));
    double share_before = 0;
    for (double frame = 0; frame < length; ++frame) {
        const double share = time.share(frame * whole / length);
        std::vector<MotionShare> shares;
        for (const BlendPart& part : parts) {
            const double moment = moment_of(part, share);
            shares.push_back({.clip = part.clip,
                              .moment = moment,
                              .moment_before = moment_of(part, share_before),
                              .weight = part.weight,
                              .support = support_at(part.support, moment)});
        }
        blend.append(shares);
        share_before = share;
    }
    return blend.clip();
}

}  // namespace kinetome
