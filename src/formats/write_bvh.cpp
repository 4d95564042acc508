#include "kinetome/formats/write_bvh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "degrees.h"
#include "kinetome/formats/euler.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/number_text.h"

namespace kinetome {
namespace {

constexpr int bvh_decimals = 6;
constexpr std::array<int, 3> x_acts_first = {0, 1, 2};

bool has_translation(const Joint& joint) {
    return !std::ranges::all_of(joint.channels, is_rotation);
}

void append_number(std::string& text, double value) {
    append_fixed(text, value, bvh_decimals);
    text += ' ';
}

void append_offset(std::string& text, const std::string& indent, const Eigen::Vector3d& offset) {
    text += indent + "OFFSET";
    for (const double value : offset) {
        text += ' ';
        append_fixed(text, value, bvh_decimals);
    }
    text += '\n';
}

}  // namespace

BvhWriter::BvhWriter(std::shared_ptr<const Skeleton> skeleton)
    : skeleton_(std::move(skeleton)),
      children_(skeleton_->joints().size()),
      last_angles_(skeleton_->joints().size(), Eigen::Vector3d::Zero()) {
    const std::vector<Joint>& joints = skeleton_->joints();
    for (size_t j = 0; j < joints.size(); ++j) {
        offsets_.push_back(joints[j].offset_before);
        if (joints[j].parent < 0) continue;
        const auto parent = static_cast<size_t>(joints[j].parent);
        offsets_[j] += joints[parent].offset_after;
        children_[parent].push_back(static_cast<int>(j));
    }
    std::vector<int> waiting = {0};
    while (!waiting.empty()) {
        const int joint = waiting.back();
        waiting.pop_back();
        written_order_.push_back(joint);
        const std::vector<int>& children = children_[static_cast<size_t>(joint)];
        waiting.insert(waiting.end(), children.rbegin(), children.rend());
    }
}

void BvhWriter::append_header(std::string& text, int64_t frames, double rate) const {
    if (!(rate > 0) || !std::isfinite(rate)) {
        throw std::invalid_argument("the rate of a take must be a positive number");
    }
    text += "HIERARCHY\n";
    append_joint(text, 0, 0);
    fmt::format_to(std::back_inserter(text), "MOTION\nFrames: {}\nFrame Time: {:.9g}\n", frames,
                   1 / rate);
}

void BvhWriter::append_joint(std::string& text, int joint, int depth) const {
    const auto index = static_cast<size_t>(joint);
    const Joint& described = skeleton_->joints()[index];
    const std::string indent(static_cast<size_t>(2 * depth), ' ');
    const std::string inner = indent + "  ";
    text += indent + (depth == 0 ? "ROOT " : "JOINT ") + described.name + '\n' + indent + "{\n";
    append_offset(text, inner, offsets_[index]);
    text += inner + (has_translation(described) ? "CHANNELS 6 Xposition Yposition Zposition"
                                                : "CHANNELS 3");
    text += " Zrotation Yrotation Xrotation\n";
    for (const int child : children_[index]) append_joint(text, child, depth + 1);
    if (children_[index].empty()) {
        text += inner + "End Site\n" + inner + "{\n";
        append_offset(text, inner + "  ", described.offset_after);
        text += inner + "}\n";
    }
    text += indent + "}\n";
}

void BvhWriter::append_frame(std::string& text, std::span<const float> dofs) {
    if (dofs.size() != static_cast<size_t>(skeleton_->dof_count())) {
        throw std::invalid_argument("a frame must have one value a degree of freedom");
    }
    for (const int joint : written_order_) {
        const auto index = static_cast<size_t>(joint);
        const Joint& described = skeleton_->joints()[index];
        const std::span<const float> own = dofs.subspan(
            static_cast<size_t>(skeleton_->first_dof(joint)), described.channels.size());
        if (has_translation(described)) {
            const Eigen::Vector3d position = offsets_[index] + local_translation(described, own);
            for (const double value : position) append_number(text, value);
        }
        Eigen::Vector3d& angles = last_angles_[index];
        angles = euler_from_rotation(local_rotation(described, own), x_acts_first, angles);
        for (const int axis : {2, 1, 0}) append_number(text, angles[axis] * degrees_per_radian);
    }
    text.back() = '\n';
}

std::string write_bvh(const Clip& clip) {
    std::string text;
    BvhWriter writer(clip.skeleton);
    writer.append_header(text, clip.frames(), clip.rate);
    const auto dof_count = static_cast<size_t>(clip.motion.cols());
    for (int64_t frame = 0; frame < clip.frames(); ++frame) {
        writer.append_frame(text, {clip.motion.row(frame).data(), dof_count});
    }
    return text;
}

}  // namespace kinetome
