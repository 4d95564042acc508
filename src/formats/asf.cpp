#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "kinetome/formats/asf_amc.h"
#include "kinetome/formats/euler.h"
#include "kinetome/formats/number_text.h"
#include "text_lines.h"

namespace kinetome {
namespace {

/// Far above any rig; bounds the depth of what walks the hierarchy.
constexpr size_t most_bones = 4096;

/// A bone as the file states it, in the file's units; the root is one too.
struct Bone {
    std::string name;
    int64_t line = 0;
    std::optional<Eigen::Vector3d> direction;
    std::optional<double> length;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();
    std::array<int, 3> axis_order = {0, 1, 2};
    std::vector<Channel> channels;
    std::vector<std::pair<double, double>> limits;
    int parent = -1;
    std::vector<int> children;
};

std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& letter : lower) {
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    }
    return lower;
}

class AsfParser {
  public:
    AsfParser(std::string_view text, const std::string& path) : lines_(text, path), path_(path) {
        bones_.emplace_back().name = "root";
        index_.emplace("root", 0);
    }

    Skeleton parse() {
        while (lines_.next()) parse_section();
        if (!length_unit_) fail_in_file("expected a 'length' in :units, found none");
        if (!has_root_) fail_in_file("expected a :root section, found none");
        if (!has_hierarchy_) fail_in_file("expected a :hierarchy section, found none");
        return build();
    }

  private:
    [[noreturn]] void fail_in_file(const std::string& reason) const {
        throw InputError::in_file(path_, reason);
    }

    bool next_in_section() {
        if (!lines_.next()) return false;
        if (lines_.words().front().front() != ':') return true;
        lines_.step_back();
        return false;
    }

    void parse_section() {
        const std::string_view found = lines_.words().front();
        if (found.front() != ':') lines_.fail_expected("a section (:units, :root …)", found);
        const std::string section = lower_case(found);
        if (section == ":name") {
            if (lines_.words().size() > 1) name_ = lines_.words()[1];
        } else if (section == ":units") {
            parse_units();
        } else if (section == ":root") {
            parse_root();
        } else if (section == ":bonedata") {
            parse_bones();
        } else if (section == ":hierarchy") {
            parse_hierarchy();
        } else {  // :version, :documentation, :skin … hold nothing that moves
            while (next_in_section()) continue;
        }
    }

    void parse_units() {
        while (next_in_section()) {
            const std::string keyword = lower_case(lines_.words().front());
            if (keyword == "length") {
                lines_.require_arguments(1, "one length unit");
                length_unit_ = lines_.number_at(1);
                if (*length_unit_ <= 0) {
                    lines_.fail_expected("a positive length unit", lines_.words()[1]);
                }
            } else if (keyword == "angle") {
                lines_.require_arguments(1, "'deg' or 'rad'");
                parse_angle_unit(lines_.words()[1]);
            }
        }
    }

    void parse_angle_unit(std::string_view word) {
        const std::string unit = lower_case(word);
        if (unit.starts_with("deg")) {
            angle_unit_ = std::numbers::pi / 180.0;
        } else if (unit.starts_with("rad")) {
            angle_unit_ = 1.0;
        } else {
            lines_.fail_expected("'deg' or 'rad'", word);
        }
    }

    void parse_root() {
        if (has_root_) lines_.fail("expected one :root section, found a second");
        has_root_ = true;
        Bone& root = bones_.front();
        root.line = lines_.number();
        while (next_in_section()) {
            const std::string keyword = lower_case(lines_.words().front());
            if (keyword == "order") {
                root.channels = parse_channels();
            } else if (keyword == "axis") {
                lines_.require_arguments(1, "an order of axes such as XYZ");
                root.axis_order = parse_axis_order(lines_.words()[1]);
            } else if (keyword == "position") {
                lines_.require_arguments(3, "three numbers");
                root.position = parse_vector();
            } else if (keyword == "orientation") {
                lines_.require_arguments(3, "three numbers");
                root.axis = parse_vector();
            } else {
                lines_.fail_expected("order, axis, position or orientation",
                                     lines_.words().front());
            }
        }
        if (root.channels.empty()) {
            throw InputError::at_line(path_, root.line,
                                      "expected an 'order' of channels in :root, found none");
        }
    }

    void parse_bones() {
        while (next_in_section()) {
            if (lower_case(lines_.words().front()) != "begin") {
                lines_.fail_expected("'begin' of a bone", lines_.words().front());
            }
            parse_bone();
        }
    }

    void parse_bone() {
        Bone bone;
        bone.line = lines_.number();
        if (bones_.size() == most_bones) {
            lines_.fail("expected at most " + std::to_string(most_bones) + " bones, found more");
        }
        for (;;) {
            if (!next_in_section()) {
                throw InputError::at_line(
                    path_, bone.line, "expected 'end' of the bone that begins here, found none");
            }
            if (lower_case(lines_.words().front()) == "end") break;
            parse_bone_field(bone);
        }
        check_bone(bone);
        if (!index_.emplace(bone.name, static_cast<int>(bones_.size())).second) {
            throw InputError::at_line(
                path_, bone.line,
                "expected each bone once, found " + quote_for_message(bone.name) + " again");
        }
        bones_.push_back(std::move(bone));
    }

    void parse_bone_field(Bone& bone) {
        const std::string keyword = lower_case(lines_.words().front());
        if (keyword == "name") {
            lines_.require_arguments(1, "one name");
            bone.name = lines_.words()[1];
            // In an AMC file such a line would be taken for the number of a frame.
            if (number_text::is_digit(bone.name.front()) || bone.name.front() == ':') {
                lines_.fail_expected("a name that begins with a letter", bone.name);
            }
        } else if (keyword == "direction") {
            lines_.require_arguments(3, "three numbers");
            bone.direction = parse_vector();
        } else if (keyword == "length") {
            lines_.require_arguments(1, "one length");
            bone.length = lines_.number_at(1);
            if (*bone.length < 0) lines_.fail_expected("a length of at least 0", lines_.words()[1]);
        } else if (keyword == "axis") {
            lines_.require_arguments(4, "three angles and an order such as XYZ");
            bone.axis = parse_vector();
            bone.axis_order = parse_axis_order(lines_.words()[4]);
        } else if (keyword == "dof") {
            bone.channels = parse_channels();
        } else if (keyword == "limits") {
            parse_limits(bone);
        } else if (keyword != "id" && keyword != "bodymass" && keyword != "cofmass") {
            lines_.fail_expected("a field of a bone or 'end'", lines_.words().front());
        }
    }

    void check_bone(const Bone& bone) const {
        const auto require = [&](bool holds, const std::string& expected) {
            if (holds) return;
            throw InputError::at_line(path_, bone.line, "expected " + expected + ", found none");
        };
        require(!bone.name.empty(), "a 'name' in the bone that begins here");
        const std::string quoted = quote_for_message(bone.name);
        require(bone.direction.has_value(), "a 'direction' of bone " + quoted);
        require(bone.length.has_value(), "a 'length' of bone " + quoted);
        if (!bone.limits.empty() && bone.limits.size() != bone.channels.size()) {
            throw InputError::at_line(path_, bone.line,
                                      "expected one pair of limits a degree of freedom of bone " +
                                          quoted + ", found " + std::to_string(bone.limits.size()) +
                                          " for " + std::to_string(bone.channels.size()));
        }
    }

    Eigen::Vector3d parse_vector() const {
        return {lines_.number_at(1), lines_.number_at(2), lines_.number_at(3)};
    }

    std::vector<Channel> parse_channels() const {
        std::vector<Channel> channels;
        for (size_t i = 1; i < lines_.words().size(); ++i) {
            const std::string_view word = lines_.words()[i];
            const std::optional<Channel> channel = find_channel(lower_case(word));
            if (!channel) lines_.fail_expected("a degree of freedom (tx ty tz rx ry rz)", word);
            if (std::ranges::find(channels, *channel) != channels.end()) {
                lines_.fail_expected("each degree of freedom once", word);
            }
            channels.push_back(*channel);
        }
        return channels;
    }

    std::array<int, 3> parse_axis_order(std::string_view word) const {
        const std::string letters = lower_case(word);
        std::string sorted = letters;
        std::ranges::sort(sorted);
        if (sorted != "xyz") lines_.fail_expected("an order of axes such as XYZ", word);
        return {letters[0] - 'x', letters[1] - 'x', letters[2] - 'x'};
    }

    /// "limits (low high)", one pair a degree of freedom, the others on lines of their own.
    void parse_limits(Bone& bone) {
        std::vector<double> bounds;
        for (size_t i = 1; i < lines_.words().size(); ++i) append_bounds(lines_.words()[i], bounds);
        while (next_in_section()) {
            if (lines_.words().front().front() != '(') {
                lines_.step_back();
                break;
            }
            for (const std::string_view word : lines_.words()) append_bounds(word, bounds);
        }
        if (bounds.size() % 2 != 0) lines_.fail("expected limits in pairs, found an odd number");
        bone.limits.clear();
        for (size_t i = 0; i < bounds.size(); i += 2) {
            bone.limits.emplace_back(bounds[i], bounds[i + 1]);
        }
    }

    /// The numbers of a word such as "(-160.0" or "(-inf"; limits may be infinite.
    void append_bounds(std::string_view word, std::vector<double>& bounds) const {
        const std::string_view whole = word;
        while (!word.empty()) {
            if (word.front() == '(' || word.front() == ')' || word.front() == ',') {
                word.remove_prefix(1);
                continue;
            }
            double bound = 0;
            const char* const last = word.data() + word.size();
            const char* const end = parse_number(word.data(), last, bound);
            if (end == nullptr || std::isnan(bound)) lines_.fail_expected("a limit", whole);
            bounds.push_back(bound);
            word.remove_prefix(static_cast<size_t>(end - word.data()));
        }
    }

    void parse_hierarchy() {
        has_hierarchy_ = true;
        while (next_in_section()) {
            const std::string keyword = lower_case(lines_.words().front());
            if (keyword == "begin" || keyword == "end") continue;
            // The bones may stand after the hierarchy, so the lines are kept until all is read.
            for (size_t i = 1; i < lines_.words().size(); ++i) {
                attachments_.push_back({std::string(lines_.words().front()),
                                        std::string(lines_.words()[i]), lines_.number()});
            }
        }
    }

    int bone_of(const std::string& name, int64_t line) const {
        const auto found = index_.find(name);
        if (found != index_.end()) return found->second;
        throw InputError::at_line(path_, line,
                                  "expected a bone of :bonedata, found " + quote_for_message(name));
    }

    void attach_bones() {
        for (const Attachment& attachment : attachments_) {
            const int parent = bone_of(attachment.parent, attachment.line);
            const int child = bone_of(attachment.child, attachment.line);
            Bone& bone = bones_[static_cast<size_t>(child)];
            if (child == 0 || bone.parent != -1) {
                throw InputError::at_line(path_, attachment.line,
                                          "expected each bone to have one parent, found " +
                                              quote_for_message(attachment.child) +
                                              (child == 0 ? " below a bone" : " attached again"));
            }
            bone.parent = parent;
            bones_[static_cast<size_t>(parent)].children.push_back(child);
        }
    }

    /// Bones depth first from the root. Each has one parent at most, so none is met twice.
    std::vector<int> bones_below_root() const {
        std::vector<int> order;
        std::vector<int> waiting = {0};
        while (!waiting.empty()) {
            const int bone = waiting.back();
            waiting.pop_back();
            order.push_back(bone);
            const std::vector<int>& children = bones_[static_cast<size_t>(bone)].children;
            waiting.insert(waiting.end(), children.rbegin(), children.rend());
        }
        return order;
    }

    void check_all_attached(const std::vector<int>& attached) const {
        if (attached.size() == bones_.size()) return;
        std::vector<bool> is_attached(bones_.size(), false);
        for (const int bone : attached) is_attached[static_cast<size_t>(bone)] = true;
        const auto at = std::ranges::find(is_attached, false) - is_attached.begin();
        const Bone& bone = bones_[static_cast<size_t>(at)];
        throw InputError::at_line(path_, bone.line,
                                  "expected the hierarchy to lead from root to bone " +
                                      quote_for_message(bone.name) + ", found " +
                                      (bone.parent == -1 ? "no parent of it" : "a cycle above it"));
    }

    Skeleton build() {
        attach_bones();
        const std::vector<int> order = bones_below_root();
        check_all_attached(order);
        std::vector<int> joint_of_bone(bones_.size(), -1);
        std::vector<Joint> joints;
        joints.reserve(order.size());
        for (const int bone_index : order) {
            const Bone& bone = bones_[static_cast<size_t>(bone_index)];
            joint_of_bone[static_cast<size_t>(bone_index)] = static_cast<int>(joints.size());
            joints.push_back(joint_from(bone));
            if (bone.parent >= 0) {
                joints.back().parent = joint_of_bone[static_cast<size_t>(bone.parent)];
            }
        }
        Skeleton skeleton(name_, std::move(joints));
        skeleton.set_source_units({.length = 2.54 / *length_unit_, .angle = angle_unit_});
        return skeleton;
    }

    Joint joint_from(const Bone& bone) const {
        const double length_unit = 2.54 / *length_unit_;
        Joint joint;
        joint.name = bone.name;
        joint.offset_before = bone.position * length_unit;
        if (bone.direction) joint.offset_after = *bone.direction * (*bone.length * length_unit);
        joint.axes = rotation_from_euler(bone.axis * angle_unit_, bone.axis_order);
        joint.channels = bone.channels;
        for (size_t i = 0; i < bone.limits.size(); ++i) {
            const double unit = is_rotation(bone.channels[i]) ? angle_unit_ : length_unit;
            joint.limits.emplace_back(bone.limits[i].first * unit, bone.limits[i].second * unit);
        }
        return joint;
    }

    struct Attachment {
        std::string parent;
        std::string child;
        int64_t line;
    };

    TextLines lines_;
    const std::string& path_;
    std::string name_;
    std::optional<double> length_unit_;
    double angle_unit_ = std::numbers::pi / 180.0;
    bool has_root_ = false;
    bool has_hierarchy_ = false;
    std::vector<Bone> bones_;
    std::map<std::string, int, std::less<>> index_;
    std::vector<Attachment> attachments_;
};

}  // namespace

Skeleton parse_asf(std::string_view text, const std::string& path) {
    return AsfParser(text, path).parse();
}

}  // namespace kinetome
