#include <cfloat>
#include <charconv>
#include <cmath>
#include <cstring>
#include <numbers>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "kinetome/formats/asf_amc.h"
#include "kinetome/formats/number_text.h"
#include "text_lines.h"

namespace kinetome {
namespace {

/// A joint that has lines in the take, ready for the inner loop.
struct JointLine {
    std::string_view name;
    int first_dof = 0;
    std::vector<double> units;  ///< what 1 stands for, in cm or radians, one a number of the line
    int64_t last_row = -1;      ///< row of the last frame it was read in
};

class AmcParser {
  public:
    AmcParser(std::string_view text, const std::string& path, const Skeleton& skeleton)
        : at_(text.data()),
          end_(text.data() + text.size()),
          path_(path),
          skeleton_(skeleton),
          angle_unit_(skeleton.source_units().angle) {}

    void parse_into(Clip& clip) {
        const int64_t claimed = count_amc_frames({at_, end_});
        parse_header(clip);
        list_joints();
        clip.motion.resize(std::min(claimed, most_frames_in_rest()), skeleton_.dof_count());
        while (skip_to_line()) {
            if (number_text::is_digit(*at_)) {
                begin_frame(clip.motion);
            } else {
                parse_joint();
            }
        }
        finish_take(clip);
    }

  private:
    static bool ends_word(char character) { return is_blank(character) || character == '\n'; }

    [[noreturn]] void fail_expected_text(const std::string& expected,
                                         const std::string& found) const {
        throw InputError::at_line(path_, line_, "expected " + expected + ", found " + found);
    }

    /// Moves to the first word of the next line that has one; false at the end of the text.
    bool skip_to_line() {
        for (; at_ != end_; ++at_) {
            if (*at_ == '#') skip_rest_of_line();
            if (at_ == end_) break;
            if (*at_ == '\n') {
                ++line_;
            } else if (!is_blank(*at_)) {
                return true;
            }
        }
        return false;
    }

    void skip_rest_of_line() {
        const void* const newline = std::memchr(at_, '\n', static_cast<size_t>(end_ - at_));
        at_ = newline == nullptr ? end_ : static_cast<const char*>(newline);
    }

    void skip_blanks() {
        while (at_ != end_ && is_blank(*at_)) ++at_;
    }

    bool at_end_of_line() {
        skip_blanks();
        return at_ == end_ || *at_ == '\n' || *at_ == '#';
    }

    std::string_view word_here() const {
        const char* word_end = at_;
        while (word_end != end_ && !ends_word(*word_end)) ++word_end;
        return {at_, word_end};
    }

    std::string quoted_word_here() const { return quote_for_message(word_here()); }

    void parse_header(Clip& clip) {
        while (skip_to_line() && !number_text::is_digit(*at_)) {
            const std::string_view keyword = word_here();
            if (keyword == ":DEGREES") {
                angle_unit_ = std::numbers::pi / 180.0;
            } else if (keyword == ":RADIANS") {
                angle_unit_ = 1.0;
            } else if (keyword == ":SAMPLES-PER-SECOND") {
                at_ += keyword.size();
                skip_blanks();
                clip.rate = parse_rate();
            } else if (keyword != ":FULLY-SPECIFIED") {
                fail_expected_text(
                    ":FULLY-SPECIFIED, :DEGREES, :RADIANS or the number of a first frame",
                    quoted_word_here());
            }
            skip_rest_of_line();
        }
    }

    double parse_rate() const {
        constexpr double lowest = 1;
        constexpr double highest = 100000;
        double rate = 0;
        const std::string_view word = word_here();
        const char* const word_end = word.data() + word.size();
        if (parse_number(word.data(), word_end, rate) != word_end || !(rate >= lowest) ||
            rate > highest) {
            fail_expected_text("a rate of 1 to 100000 frames a second", quoted_word_here());
        }
        return rate;
    }

    void list_joints() {
        const double length_unit = skeleton_.source_units().length;
        for (int j = 0; j < skeleton_.joint_count(); ++j) {
            const Joint& joint = skeleton_.joints()[static_cast<size_t>(j)];
            JointLine line{.name = joint.name, .first_dof = skeleton_.first_dof(j), .units = {}};
            for (const Channel channel : joint.channels) {
                line.units.push_back(is_rotation(channel) ? angle_unit_ : length_unit);
            }
            if (!joint.channels.empty()) ++moving_joints_;
            index_.emplace(line.name, joints_.size());
            joints_.push_back(std::move(line));
        }
        order_.reserve(joints_.size());
    }

    /// More frames than the rest of the text has room for, so that no claim costs more memory
    /// than a small multiple of the text.
    int64_t most_frames_in_rest() const {
        int64_t least_bytes = 2;
        for (const JointLine& joint : joints_) {
            if (joint.units.empty()) continue;
            least_bytes += static_cast<int64_t>(joint.name.size() + 2 * joint.units.size() + 1);
        }
        return (end_ - at_) / least_bytes + 1;
    }

    void begin_frame(MatrixF& motion) {
        require_whole_frame("the next frame");
        int64_t number = 0;
        const auto [number_end, error] = std::from_chars(at_, end_, number);
        const bool is_number =
            error == std::errc() && (number_end == end_ || ends_word(*number_end));
        const bool follows = is_number && (row_ < 0 || number == frame_number_ + 1);
        if (!follows) {
            fail_expected_text(row_ < 0 ? "the number of a first frame"
                                        : "frame " + std::to_string(frame_number_ + 1),
                               quoted_word_here());
        }
        at_ = number_end;
        if (!at_end_of_line()) {
            fail_expected_text("nothing after the number of a frame", quoted_word_here());
        }
        frame_number_ = number;
        ++row_;
        if (row_ >= motion.rows()) throw std::logic_error("more frames than the text has room for");
        values_ = motion.row(row_).data();
        place_ = 0;
        joints_read_ = 0;
    }

    /// Every joint that moves must have had its line.
    void require_whole_frame(const std::string& found) const {
        if (row_ < 0 || joints_read_ == moving_joints_) return;
        for (const JointLine& joint : joints_) {
            if (joint.units.empty() || joint.last_row == row_) continue;
            fail_expected_text("bone " + quote_for_message(joint.name) + " in frame " +
                                   std::to_string(frame_number_),
                               found);
        }
    }

    void finish_take(Clip& clip) {
        if (row_ < 0) fail_expected_text("the number of a first frame", "no frame at all");
        if (lacks_last_line_only()) {
            hold_last_joint(clip);
        } else {
            require_whole_frame("the end of the file");
        }
        clip.motion.conservativeResize(row_ + 1, Eigen::NoChange);
    }

    /// Whether the text is whole but for the last line of its last frame, as in takes that CMU
    /// publishes; a line that breaks off, or more than one line missing, is damage.
    bool lacks_last_line_only() const {
        return row_ > 0 && joints_read_ + 1 == moving_joints_ && place_ + 1 == order_.size() &&
               joints_[order_[place_]].last_row == row_ - 1 && end_[-1] == '\n';
    }

    void hold_last_joint(Clip& clip) const {
        const JointLine& joint = joints_[order_[place_]];
        const auto count = static_cast<int64_t>(joint.units.size());
        clip.motion.row(row_).segment(joint.first_dof, count) =
            clip.motion.row(row_ - 1).segment(joint.first_dof, count);
        clip.warnings.push_back("the last line of the last frame is missing; bone " +
                                quote_for_message(joint.name) +
                                " keeps its values of the frame before");
    }

    void parse_joint() {
        JointLine& joint = joint_here();
        if (joint.last_row == row_) {
            fail_expected_text(
                "each bone once in a frame",
                quote_for_message(joint.name) + " again in frame " + std::to_string(frame_number_));
        }
        joint.last_row = row_;
        joints_read_ += !joint.units.empty();
        at_ += joint.name.size();
        parse_values(joint);
        if (at_end_of_line()) return;
        fail_expected_text("the end of the line after " + count_of_numbers(joint),
                           quoted_word_here());
    }

    void parse_values(const JointLine& joint) {
        const char* at = at_;
        float* value = values_ + joint.first_dof;
        for (const double unit : joint.units) {
            while (at != end_ && is_blank(*at)) ++at;
            double number = 0;
            const char* const number_end = parse_number(at, end_, number);
            number *= unit;
            const bool is_number = number_end != nullptr && std::abs(number) <= double{FLT_MAX} &&
                                   (number_end == end_ || ends_word(*number_end));
            if (!is_number) {
                at_ = at;
                fail_value(joint);
            }
            *value++ = static_cast<float>(number);
            at = number_end;
        }
        at_ = at;
    }

    /// Frames of a take list their joints in one order, so the one that stood here in the last
    /// frame is tried before the table.
    JointLine& joint_here() {
        if (place_ < order_.size()) {
            JointLine& expected = joints_[order_[place_]];
            const std::string_view name = expected.name;
            const auto left = static_cast<size_t>(end_ - at_);
            if (left > name.size() && std::memcmp(at_, name.data(), name.size()) == 0 &&
                ends_word(at_[name.size()])) {
                ++place_;
                return expected;
            }
        }
        const auto found = index_.find(word_here());
        if (found == index_.end()) fail_expected_text("a bone of the skeleton", quoted_word_here());
        if (place_ == order_.size()) order_.push_back(0);
        order_[place_++] = found->second;
        return joints_[found->second];
    }

    [[noreturn]] void fail_value(const JointLine& joint) {
        if (at_end_of_line()) {
            fail_expected_text(count_of_numbers(joint), "the end of the line");
        }
        fail_expected_text("a finite number", quoted_word_here());
    }

    static std::string count_of_numbers(const JointLine& joint) {
        return std::to_string(joint.units.size()) +
               (joint.units.size() == 1 ? " number" : " numbers") + " of bone " +
               quote_for_message(joint.name);
    }

    const char* at_;
    const char* const end_;
    int64_t line_ = 1;
    const std::string& path_;
    const Skeleton& skeleton_;
    double angle_unit_;

    std::vector<JointLine> joints_;
    std::unordered_map<std::string_view, size_t> index_;
    std::vector<size_t> order_;  ///< joint that stood at each place of the last frame
    int moving_joints_ = 0;

    int64_t row_ = -1;
    int64_t frame_number_ = 0;
    float* values_ = nullptr;
    size_t place_ = 0;
    int joints_read_ = 0;
};

}  // namespace

Clip parse_amc(std::string_view text, const std::string& path,
               std::shared_ptr<const Skeleton> skeleton, const AmcOptions& options) {
    if (!(options.rate > 0) || !std::isfinite(options.rate)) {
        throw std::invalid_argument("the rate of a take must be a positive number");
    }
    Clip clip;
    clip.rate = options.rate;
    AmcParser(text, path, *skeleton).parse_into(clip);
    clip.skeleton = std::move(skeleton);
    return clip;
}

int64_t count_amc_frames(std::string_view text) {
    int64_t frames = 0;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at != end) {
        while (at != end && is_blank(*at)) ++at;
        if (at == end) break;
        frames += number_text::is_digit(*at);
        const void* const newline = std::memchr(at, '\n', static_cast<size_t>(end - at));
        if (newline == nullptr) break;
        at = static_cast<const char*>(newline) + 1;
    }
    return frames;
}

}  // namespace kinetome
