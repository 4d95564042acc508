#include <algorithm>
#include <map>
#include <utility>

#include "asf_file.h"
#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"
#include "kinetome/formats/asf_amc.h"
#include "kinetome/formats/euler.h"
#include "text_lines.h"

namespace kinetome {
namespace {

/// The hierarchy of a file's bones, by their index in the file.
struct BoneTree {
    std::vector<int> parents;  ///< -1: none
    std::vector<std::vector<int>> children;
};

BoneTree attach_bones(const AsfFile& file, const std::string& path) {
    std::map<std::string_view, int> index;
    for (const AsfBone& bone : file.bones) index.emplace(bone.name, static_cast<int>(index.size()));
    const auto bone_of = [&](const std::string& name, int64_t line) {
        const auto found = index.find(name);
        if (found != index.end()) return found->second;
        throw InputError::at_line(path, line,
                                  "expected a bone of :bonedata, found " + quote_for_message(name));
    };

    BoneTree tree{std::vector<int>(file.bones.size(), -1),
                  std::vector<std::vector<int>>(file.bones.size())};
    for (const AsfAttachment& attachment : file.attachments) {
        const int parent = bone_of(attachment.parent, attachment.line);
        const int child = bone_of(attachment.child, attachment.line);
        int& parent_of_child = tree.parents[static_cast<size_t>(child)];
        if (child == 0 || parent_of_child != -1) {
            throw InputError::at_line(path, attachment.line,
                                      "expected each bone to have one parent, found " +
                                          quote_for_message(attachment.child) +
                                          (child == 0 ? " below a bone" : " attached again"));
        }
        parent_of_child = parent;
        tree.children[static_cast<size_t>(parent)].push_back(child);
    }
    return tree;
}

/// Bones depth first from the root. Each has one parent at most, so none is met twice.
std::vector<int> bones_below_root(const BoneTree& tree) {
    std::vector<int> order;
    std::vector<int> waiting = {0};
    while (!waiting.empty()) {
        const int bone = waiting.back();
        waiting.pop_back();
        order.push_back(bone);
        const std::vector<int>& children = tree.children[static_cast<size_t>(bone)];
        waiting.insert(waiting.end(), children.rbegin(), children.rend());
    }
    return order;
}

void check_all_attached(const AsfFile& file, const BoneTree& tree, const std::vector<int>& attached,
                        const std::string& path) {
    if (attached.size() == file.bones.size()) return;
    std::vector<bool> is_attached(file.bones.size(), false);
    for (const int bone : attached) is_attached[static_cast<size_t>(bone)] = true;
    const auto lost =
        static_cast<size_t>(std::ranges::find(is_attached, false) - is_attached.begin());
    const AsfBone& bone = file.bones[lost];
    throw InputError::at_line(
        path, bone.line,
        "expected the hierarchy to lead from root to bone " + quote_for_message(bone.name) +
            ", found " + (tree.parents[lost] == -1 ? "no parent of it" : "a cycle above it"));
}

Joint joint_from(const AsfBone& bone, const SourceUnits& units, const std::string& path) {
    Joint joint;
    joint.name = bone.name;
    joint.offset_before = bone.position * units.length;
    if (bone.direction) joint.offset_after = *bone.direction * (*bone.length * units.length);
    if (!joint.offset_before.allFinite() || !joint.offset_after.allFinite()) {
        throw InputError::at_line(path, bone.line,
                                  "expected a finite size of bone " + quote_for_message(bone.name) +
                                      ", found one beyond all bounds");
    }
    joint.axes = rotation_from_euler(bone.axis * units.angle, bone.axis_order);
    joint.channels = bone.channels;
    for (size_t i = 0; i < bone.limits.size(); ++i) {
        const double unit = is_rotation(bone.channels[i]) ? units.angle : units.length;
        joint.limits.emplace_back(bone.limits[i].first * unit, bone.limits[i].second * unit);
    }
    return joint;
}

}  // namespace

Skeleton parse_asf(std::string_view text, const std::string& path) {
    require_text(text, path);
    AsfFile file = read_asf_file(text, path);
    const BoneTree tree = attach_bones(file, path);
    const std::vector<int> order = bones_below_root(tree);
    check_all_attached(file, tree, order, path);

    const SourceUnits units{.length = 2.54 / file.length, .angle = file.angle};
    std::vector<int> joint_of_bone(file.bones.size(), -1);
    std::vector<Joint> joints;
    joints.reserve(order.size());
    for (const int bone_index : order) {
        const auto bone = static_cast<size_t>(bone_index);
        joint_of_bone[bone] = static_cast<int>(joints.size());
        joints.push_back(joint_from(file.bones[bone], units, path));
        const int parent = tree.parents[bone];
        if (parent >= 0) joints.back().parent = joint_of_bone[static_cast<size_t>(parent)];
    }
    Skeleton skeleton(std::move(file.name), std::move(joints));
    skeleton.set_source_units(units);
    return skeleton;
}

}  // namespace kinetome
