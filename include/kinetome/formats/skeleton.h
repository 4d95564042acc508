// A hierarchy of joints with degrees of freedom, one description for ASF and BVH alike.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinetome {

/// One column of a motion: a translation (cm) or a rotation about an axis (radians).
enum class Channel : uint8_t { tx, ty, tz, rx, ry, rz };

constexpr bool is_rotation(Channel channel) {
    return channel >= Channel::rx;
}
/// 0 for x, 1 for y, 2 for z.
constexpr int axis_of(Channel channel) {
    return static_cast<int>(channel) % 3;
}

/// "tx" … "rz".
std::string_view channel_name(Channel channel);
/// The channel of that (lower-case) name, if any.
std::optional<Channel> find_channel(std::string_view name);

/// What a joint is to the features, whatever its rig calls it. For ASF a joint is a bone and its
/// position the bone's far end: the left ankle is the end of `ltibia`.
enum class JointRole : uint8_t {
    root,
    left_hip,
    right_hip,
    left_knee,
    right_knee,
    left_ankle,
    right_ankle,
    left_toes,
    right_toes,
    lower_neck,
    head,
    left_shoulder,
    right_shoulder,
    left_elbow,
    right_elbow,
    left_wrist,
    right_wrist,
};
inline constexpr int joint_role_count = 17;
std::string_view joint_role_name(JointRole role);

/// A joint turns by R = axes · (product of its rotations) · axesᵀ in its parent's frame, and
///   position = parent's position + parent's rotation · (offset_before + translation)
///            + own rotation · offset_after.
/// ASF bones use offset_after (direction × length), BVH joints offset_before.
struct Joint {
    std::string name;
    int parent = -1;  ///< index of the parent, always smaller than the joint's own; -1: the root
    Eigen::Vector3d offset_before = Eigen::Vector3d::Zero();  ///< cm
    Eigen::Vector3d offset_after = Eigen::Vector3d::Zero();   ///< cm
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();       ///< ASF `axis`; identity for BVH
    std::vector<Channel> channels = {};  ///< columns of the joint, in the order of a clip's columns
    /// ASF: the first rotation listed acts first (rx ry rz: R = Rz·Ry·Rx). BVH: it acts last.
    bool first_rotation_acts_first = true;
    /// Allowed range of each channel (radians or cm); empty when the source states none.
    std::vector<std::pair<double, double>> limits = {};
};

/// What one unit of a source file is here. An AMC file is written in the units of its ASF file.
struct SourceUnits {
    double length = 2.54 / 0.45;              ///< cm; ASF: an inch divided by the stated length
    double angle = std::numbers::pi / 180.0;  ///< radians
};

class Skeleton {
  public:
    Skeleton() = default;
    /// Joints in any order that puts parents first; joint 0 is the root. Throws
    /// std::invalid_argument when that does not hold or a name stands twice.
    Skeleton(std::string name, std::vector<Joint> joints);

    const std::string& name() const { return name_; }
    const std::vector<Joint>& joints() const { return joints_; }
    int joint_count() const { return static_cast<int>(joints_.size()); }
    /// Columns of a clip: joints in order, channels in order.
    int dof_count() const { return dof_count_; }
    /// First column of a joint.
    int first_dof(int joint) const { return first_dof_[static_cast<size_t>(joint)]; }
    /// "lfemur.rx" and so on, one a column.
    std::vector<std::string> dof_names() const;
    std::optional<int> find(std::string_view joint_name) const;

    /// Joint of a role, or -1. Set by assign_roles (joint_roles.h).
    int role(JointRole role) const { return roles_[static_cast<size_t>(role)]; }
    void set_role(JointRole role, int joint) { roles_[static_cast<size_t>(role)] = joint; }

    const SourceUnits& source_units() const { return source_units_; }
    void set_source_units(const SourceUnits& units) { source_units_ = units; }

    /// Names the class of skeletons that share pose models: joint names, parents, channels and
    /// their order; lengths and axes are free. "<joints>j<dofs>d-<8 hexadecimal digits>".
    std::string class_name() const;

  private:
    std::string name_;
    std::vector<Joint> joints_;
    std::vector<int> first_dof_;
    int dof_count_ = 0;
    SourceUnits source_units_;
    std::array<int, joint_role_count> roles_ = make_no_roles();

    static constexpr std::array<int, joint_role_count> make_no_roles() {
        std::array<int, joint_role_count> none{};
        for (int& joint : none) joint = -1;
        return none;
    }
};

}  // namespace kinetome
