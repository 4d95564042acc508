#include "kinetome/formats/write_amc.h"

#include <fmt/format.h>

#include <iterator>
#include <numbers>
#include <stdexcept>

#include "degrees.h"
#include "kinetome/base/quote.h"
#include "kinetome/formats/euler.h"
#include "kinetome/formats/number_text.h"

namespace kinetome {
namespace {

constexpr int amc_decimals = 5;

void check_asf_can_hold(const Joint& joint) {
    const bool is_root = joint.parent < 0;
    const Eigen::Vector3d& without_place = is_root ? joint.offset_after : joint.offset_before;
    if (without_place == Eigen::Vector3d::Zero() && joint.first_rotation_acts_first &&
        is_root == (joint.name == "root")) {
        return;
    }
    throw std::invalid_argument("joint " + quote_for_message(joint.name) +
                                " is not one that ASF can hold; write BVH instead");
}

void append_vector(std::string& text, const Eigen::Vector3d& vector) {
    fmt::format_to(std::back_inserter(text), "{:.12g} {:.12g} {:.12g}", vector.x(), vector.y(),
                   vector.z());
}

Eigen::Vector3d axis_angles(const Joint& joint) {
    return degrees_per_radian * euler_from_rotation(joint.axes, {0, 1, 2}, Eigen::Vector3d::Zero());
}

void append_channels(std::string& text, const Joint& joint) {
    for (const Channel channel : joint.channels) {
        text += ' ';
        text += channel_name(channel);
    }
    text += '\n';
}

void append_root(std::string& text, const Joint& root, double length_unit) {
    text += ":root\n  order";
    append_channels(text, root);
    text += "  axis XYZ\n  position ";
    append_vector(text, root.offset_before / length_unit);
    text += "\n  orientation ";
    append_vector(text, axis_angles(root));
    text += '\n';
}

void append_limits(std::string& text, const Joint& joint, double length_unit) {
    for (size_t i = 0; i < joint.limits.size(); ++i) {
        const double factor = is_rotation(joint.channels[i]) ? degrees_per_radian : 1 / length_unit;
        fmt::format_to(std::back_inserter(text), "{}({:.12g} {:.12g})\n",
                       i == 0 ? "    limits " : "           ", joint.limits[i].first * factor,
                       joint.limits[i].second * factor);
    }
}

void append_bone(std::string& text, const Joint& joint, int id, double length_unit) {
    const double length = joint.offset_after.norm();
    const Eigen::Vector3d direction =
        length > 0 ? Eigen::Vector3d(joint.offset_after / length) : Eigen::Vector3d::UnitY();
    fmt::format_to(std::back_inserter(text), "  begin\n    id {}\n    name {}\n    direction ", id,
                   joint.name);
    append_vector(text, direction);
    fmt::format_to(std::back_inserter(text), "\n    length {:.12g}\n    axis ",
                   length / length_unit);
    append_vector(text, axis_angles(joint));
    text += " XYZ\n";
    if (!joint.channels.empty()) {
        text += "    dof";
        append_channels(text, joint);
        append_limits(text, joint, length_unit);
    }
    text += "  end\n";
}

void append_hierarchy(std::string& text, const Skeleton& skeleton) {
    text += ":hierarchy\n  begin\n";
    for (int parent = 0; parent < skeleton.joint_count(); ++parent) {
        std::string children;
        for (const Joint& joint : skeleton.joints()) {
            if (joint.parent == parent) children += ' ' + joint.name;
        }
        if (children.empty()) continue;
        text += "    " + skeleton.joints()[static_cast<size_t>(parent)].name + children + '\n';
    }
    text += "  end\n";
}

}  // namespace

std::string write_asf(const Skeleton& skeleton) {
    const double length_unit = skeleton.source_units().length;
    std::string text = ":version 1.10\n";
    text += ":name " + (skeleton.name().empty() ? "skeleton" : skeleton.name()) + '\n';
    fmt::format_to(std::back_inserter(text), ":units\n  mass 1.0\n  length {:.12g}\n  angle deg\n",
                   2.54 / length_unit);
    for (const Joint& joint : skeleton.joints()) check_asf_can_hold(joint);
    append_root(text, skeleton.joints().front(), length_unit);
    text += ":bonedata\n";
    for (int j = 1; j < skeleton.joint_count(); ++j) {
        append_bone(text, skeleton.joints()[static_cast<size_t>(j)], j, length_unit);
    }
    append_hierarchy(text, skeleton);
    return text;
}

void append_amc_header(std::string& text) {
    text += ":FULLY-SPECIFIED\n:DEGREES\n";
}

void append_amc_frame(std::string& text, const Skeleton& skeleton, int64_t frame_number,
                      std::span<const float> dofs) {
    if (dofs.size() != static_cast<size_t>(skeleton.dof_count())) {
        throw std::invalid_argument("a frame must have one value a degree of freedom");
    }
    const double units_per_cm = 1 / skeleton.source_units().length;
    append_integer(text, frame_number);
    text += '\n';
    const float* value = dofs.data();
    for (const Joint& joint : skeleton.joints()) {
        if (joint.channels.empty()) continue;
        text += joint.name;
        for (const Channel channel : joint.channels) {
            const double factor = is_rotation(channel) ? degrees_per_radian : units_per_cm;
            text += ' ';
            append_fixed(text, static_cast<double>(*value++) * factor, amc_decimals);
        }
        text += '\n';
    }
}

std::string write_amc(const Clip& clip) {
    std::string text;
    append_amc_header(text);
    const auto dof_count = static_cast<size_t>(clip.motion.cols());
    for (int64_t frame = 0; frame < clip.frames(); ++frame) {
        append_amc_frame(text, *clip.skeleton, frame + 1,
                         {clip.motion.row(frame).data(), dof_count});
    }
    return text;
}

}  // namespace kinetome
