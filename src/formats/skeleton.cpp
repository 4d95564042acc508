#include "kinetome/formats/skeleton.h"

#include <set>
#include <stdexcept>

#include "kinetome/base/digest.h"
#include "kinetome/base/quote.h"

namespace kinetome {
namespace {

constexpr std::array<std::string_view, 6> channel_names = {"tx", "ty", "tz", "rx", "ry", "rz"};

void check_joint(const Joint& joint, size_t index) {
    const int parent = joint.parent;
    if (index == 0 ? parent != -1 : (parent < 0 || static_cast<size_t>(parent) >= index)) {
        throw std::invalid_argument("joint " + quote_for_message(joint.name) +
                                    " must follow its parent, and only joint 0 has none");
    }
    if (!joint.limits.empty() && joint.limits.size() != joint.channels.size()) {
        throw std::invalid_argument("joint " + quote_for_message(joint.name) +
                                    " must have one pair of limits a channel, or none");
    }
}

}  // namespace

std::string_view channel_name(Channel channel) {
    return channel_names[static_cast<size_t>(channel)];
}

std::optional<Channel> find_channel(std::string_view name) {
    for (size_t i = 0; i < channel_names.size(); ++i) {
        if (channel_names[i] == name) return static_cast<Channel>(i);
    }
    return std::nullopt;
}

Skeleton::Skeleton(std::string name, std::vector<Joint> joints)
    : name_(std::move(name)), joints_(std::move(joints)) {
    std::set<std::string_view> names;
    first_dof_.reserve(joints_.size());
    for (size_t i = 0; i < joints_.size(); ++i) {
        check_joint(joints_[i], i);
        if (!names.insert(joints_[i].name).second) {
            throw std::invalid_argument("joint " + quote_for_message(joints_[i].name) +
                                        " stands twice");
        }
        first_dof_.push_back(dof_count_);
        dof_count_ += static_cast<int>(joints_[i].channels.size());
    }
}

std::vector<std::string> Skeleton::dof_names() const {
    std::vector<std::string> names;
    names.reserve(static_cast<size_t>(dof_count_));
    for (const Joint& joint : joints_) {
        for (const Channel channel : joint.channels) {
            names.push_back(joint.name + '.' + std::string(channel_name(channel)));
        }
    }
    return names;
}

std::optional<int> Skeleton::find(std::string_view joint_name) const {
    for (size_t i = 0; i < joints_.size(); ++i) {
        if (joints_[i].name == joint_name) return static_cast<int>(i);
    }
    return std::nullopt;
}

std::string Skeleton::class_name() const {
    Hasher hasher;
    for (const Joint& joint : joints_) {
        // Unsigned, so that the root's -1 becomes a number like any other.
        hasher.text(joint.name).number(static_cast<uint64_t>(joint.parent));
        hasher.number(joint.first_rotation_acts_first ? 1 : 0).number(joint.channels.size());
        for (const Channel channel : joint.channels) hasher.number(static_cast<uint64_t>(channel));
    }
    return std::to_string(joint_count()) + "j" + std::to_string(dof_count_) + "d-" +
           hasher.finish().hex().substr(0, 8);
}

}  // namespace kinetome
