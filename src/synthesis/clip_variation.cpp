#include "kinetome/synthesis/clip_variation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "kinetome/formats/resample.h"
#include "kinetome/synthesis/drift.h"

namespace kinetome {
namespace {

/// What a reflection in x = 0 does to a channel: M · R · M of a turn about y or z is the turn back.
constexpr double reflected_sign(Channel channel) {
    return channel == Channel::tx || channel == Channel::ry || channel == Channel::rz ? -1.0 : 1.0;
}

Eigen::Vector3d reflected(const Eigen::Vector3d& vector) {
    return {-vector.x(), vector.y(), vector.z()};
}

Eigen::Matrix3d reflected(const Eigen::Matrix3d& rotation) {
    const Eigen::Vector3d mirror(-1, 1, 1);
    return mirror.asDiagonal() * rotation * mirror.asDiagonal();
}

/// The words by which rigs tell sides apart; in front of a name, or anywhere when whole words.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> side_words = {
    {{"left", "right"}, {"Left", "Right"}, {"LEFT", "RIGHT"}}};

/// The name with the first word of a side exchanged; nothing when there is none.
std::optional<std::string> with_words_exchanged(std::string_view name) {
    for (const auto& [left, right] : side_words) {
        for (const auto& [from, to] : {std::pair(left, right), std::pair(right, left)}) {
            const size_t at = name.find(from);
            if (at == std::string_view::npos) continue;
            return std::string(name.substr(0, at)).append(to).append(name.substr(at + from.size()));
        }
    }
    return std::nullopt;
}

/// The joint on the other side, or the joint itself when it is in the middle.
int partner_of(const Skeleton& skeleton, int joint) {
    const std::string& name = skeleton.joints()[static_cast<size_t>(joint)].name;
    if (const auto exchanged = with_words_exchanged(name)) {
        if (const auto found = skeleton.find(*exchanged)) return *found;
    }
    std::string exchanged = name;
    const char first = name.empty() ? ' ' : name.front();
    if (first == 'l') exchanged.front() = 'r';
    if (first == 'r') exchanged.front() = 'l';
    return skeleton.find(exchanged).value_or(joint);
}

std::vector<int> partners_of(const Skeleton& skeleton) {
    std::vector<int> partners;
    for (int j = 0; j < skeleton.joint_count(); ++j) partners.push_back(partner_of(skeleton, j));
    for (int j = 0; j < skeleton.joint_count(); ++j) {
        const Joint& own = skeleton.joints()[static_cast<size_t>(j)];
        const Joint& other =
            skeleton.joints()[static_cast<size_t>(partners[static_cast<size_t>(j)])];
        const int expected = own.parent < 0 ? -1 : partners[static_cast<size_t>(own.parent)];
        if (own.channels != other.channels || other.parent != expected ||
            own.first_rotation_acts_first != other.first_rotation_acts_first)
            throw std::invalid_argument("joints " + own.name + " and " + other.name +
                                        " cannot mirror each other");
    }
    return partners;
}

Joint reflected(const Joint& partner, const Joint& own) {
    Joint joint = partner;
    joint.name = own.name;
    joint.parent = own.parent;
    joint.offset_before = reflected(partner.offset_before);
    joint.offset_after = reflected(partner.offset_after);
    joint.axes = reflected(partner.axes);
    for (size_t i = 0; i < joint.limits.size(); ++i) {
        auto& [low, high] = joint.limits[i];
        if (reflected_sign(joint.channels[i]) < 0) {
            const double old_low = low;
            low = -high;
            high = -old_low;
        }
    }
    return joint;
}

/// The same joints in the same places of the same rig, with other shapes.
Skeleton reshaped(const Skeleton& skeleton, std::vector<Joint> joints) {
    Skeleton result(skeleton.name(), std::move(joints));
    result.set_source_units(skeleton.source_units());
    for (int role = 0; role < joint_role_count; ++role)
        result.set_role(static_cast<JointRole>(role), skeleton.role(static_cast<JointRole>(role)));
    return result;
}

}  // namespace

Skeleton mirrored(const Skeleton& skeleton) {
    const std::vector<int> partners = partners_of(skeleton);
    std::vector<Joint> joints;
    for (size_t j = 0; j < partners.size(); ++j)
        joints.push_back(
            reflected(skeleton.joints()[static_cast<size_t>(partners[j])], skeleton.joints()[j]));
    return reshaped(skeleton, std::move(joints));
}

Clip mirrored(const Clip& clip) {
    const Skeleton& skeleton = *clip.skeleton;
    const std::vector<int> partners = partners_of(skeleton);
    Clip image = clip;
    image.skeleton = std::make_shared<const Skeleton>(mirrored(skeleton));
    for (int j = 0; j < skeleton.joint_count(); ++j) {
        const std::vector<Channel>& channels = skeleton.joints()[static_cast<size_t>(j)].channels;
        const int to = skeleton.first_dof(j);
        const int from = skeleton.first_dof(partners[static_cast<size_t>(j)]);
        for (size_t i = 0; i < channels.size(); ++i) {
            const auto offset = static_cast<int>(i);
            image.motion.col(to + offset) =
                static_cast<float>(reflected_sign(channels[i])) * clip.motion.col(from + offset);
        }
    }
    return image;
}

std::string mirrored_label(std::string_view label) {
    return with_words_exchanged(label).value_or(std::string(label));
}

Skeleton scaled(const Skeleton& skeleton, double factor) {
    std::vector<Joint> joints = skeleton.joints();
    for (Joint& joint : joints) {
        joint.offset_before *= factor;
        joint.offset_after *= factor;
        for (size_t i = 0; i < joint.limits.size(); ++i) {
            if (is_rotation(joint.channels[i])) continue;
            joint.limits[i].first *= factor;
            joint.limits[i].second *= factor;
        }
    }
    return reshaped(skeleton, std::move(joints));
}

Clip scaled(const Clip& clip, double factor) {
    Clip result = clip;
    result.skeleton = std::make_shared<const Skeleton>(scaled(*clip.skeleton, factor));
    for (int j = 0; j < clip.skeleton->joint_count(); ++j) {
        const std::vector<Channel>& channels =
            clip.skeleton->joints()[static_cast<size_t>(j)].channels;
        for (size_t i = 0; i < channels.size(); ++i) {
            if (is_rotation(channels[i])) continue;
            result.motion.col(clip.skeleton->first_dof(j) + static_cast<int>(i)) *=
                static_cast<float>(factor);
        }
    }
    return result;
}

TimeWarp::TimeWarp(int64_t source_frames, RandomStream& random) {
    constexpr double slowest = 0.7, fastest = 1.4;
    constexpr double frame_seconds = 1.0 / 120;
    const double pace = random.uniform(std::log(0.8), std::log(1.25));
    Drift wandering(0.12, 1.5, random);
    const auto last = static_cast<double>(source_frames - 1);
    for (double at = 0; at <= last;) {
        source_frames_.push_back(at);
        const double speed = std::exp(pace + wandering.next(frame_seconds, random));
        at += std::clamp(speed, slowest, fastest);
    }
}

void TimeWarp::cut(int64_t frames) {
    source_frames_.resize(static_cast<size_t>(std::min(frames, this->frames())));
}

int64_t TimeWarp::frame_at(int64_t source_frame) const {
    return std::ranges::lower_bound(source_frames_, static_cast<double>(source_frame)) -
           source_frames_.begin();
}

}  // namespace kinetome
