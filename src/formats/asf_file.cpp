#include "asf_file.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "kinetome/formats/number_text.h"
#include "text_lines.h"

namespace kinetome {
namespace {

/// Far above any rig; bounds the depth of what walks the hierarchy.
constexpr size_t most_bones = 4096;

class AsfReader {
  public:
    AsfReader(std::string_view text, const std::string& path) : lines_(text, path), path_(path) {
        file_.bones.emplace_back().name = "root";
        names_.insert("root");
    }

    AsfFile read() {
        while (lines_.next()) parse_section();
        if (file_.length == 0) fail_in_file("expected a 'length' in :units, found none");
        if (!has_root_) fail_in_file("expected a :root section, found none");
        if (!has_hierarchy_) fail_in_file("expected a :hierarchy section, found none");
        return std::move(file_);
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
            if (lines_.words().size() > 1) file_.name = lines_.words()[1];
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
                file_.length = lines_.number_at(1);
                if (file_.length <= 0) {
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
            file_.angle = std::numbers::pi / 180.0;
        } else if (unit.starts_with("rad")) {
            file_.angle = 1.0;
        } else {
            lines_.fail_expected("'deg' or 'rad'", word);
        }
    }

    void parse_root() {
        if (has_root_) lines_.fail("expected one :root section, found a second");
        has_root_ = true;
        AsfBone& root = file_.bones.front();
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
        AsfBone bone;
        bone.line = lines_.number();
        if (file_.bones.size() == most_bones) {
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
        if (!names_.insert(bone.name).second) {
            throw InputError::at_line(
                path_, bone.line,
                "expected each bone once, found " + quote_for_message(bone.name) + " again");
        }
        file_.bones.push_back(std::move(bone));
    }

    void parse_bone_field(AsfBone& bone) {
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

    void check_bone(const AsfBone& bone) const {
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
    void parse_limits(AsfBone& bone) {
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
                file_.attachments.push_back({std::string(lines_.words().front()),
                                             std::string(lines_.words()[i]), lines_.number()});
            }
        }
    }

    TextLines lines_;
    const std::string& path_;
    AsfFile file_;
    bool has_root_ = false;
    bool has_hierarchy_ = false;
    std::set<std::string> names_;
};

}  // namespace

AsfFile read_asf_file(std::string_view text, const std::string& path) {
    return AsfReader(text, path).read();
}

}  // namespace kinetome
