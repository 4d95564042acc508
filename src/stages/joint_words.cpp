#include "joint_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "kinetome/features/effectors.h"

namespace kinetome {
namespace {

struct Word {
    std::string text;
    std::set<JointRole> joints;
};

/// Words that stand for more joints come first.
const std::vector<Word>& words() {
    static const std::vector<Word> all = {
        {"all", {effector_roles.begin(), effector_roles.end()}},
        {"arms", {JointRole::left_wrist, JointRole::right_wrist}},
        {"legs", {JointRole::left_ankle, JointRole::right_ankle}},
        {"head", {JointRole::head}},
        {"left-arm", {JointRole::left_wrist}},
        {"right-arm", {JointRole::right_wrist}},
        {"left-leg", {JointRole::left_ankle}},
        {"right-leg", {JointRole::right_ankle}},
    };
    return all;
}

}  // namespace

std::vector<std::string> joint_words() {
    std::vector<std::string> texts;
    for (const Word& word : words()) texts.push_back(word.text);
    return texts;
}

std::optional<std::vector<JointRole>> parse_joints(std::string_view text) {
    std::set<JointRole> chosen;
    std::istringstream parts{std::string(text)};
    for (std::string part; std::getline(parts, part, ',');) {
        const auto word =
            std::ranges::find_if(words(), [&](const Word& one) { return one.text == part; });
        if (word == words().end()) return std::nullopt;
        chosen.insert(word->joints.begin(), word->joints.end());
    }
    if (chosen.empty()) return std::nullopt;
    std::vector<JointRole> joints;
    for (const JointRole role : effector_roles) {
        if (chosen.count(role)) joints.push_back(role);
    }
    return joints;
}

std::string write_joints(const std::vector<JointRole>& joints) {
    std::set<JointRole> left(joints.begin(), joints.end());
    std::vector<std::string> texts;
    for (const Word& word : words()) {
        if (left.empty() || !std::ranges::includes(left, word.joints)) continue;
        texts.push_back(word.text);
        for (const JointRole joint : word.joints) left.erase(joint);
    }
    return fmt::format("{}", fmt::join(texts, ","));
}

}  // namespace kinetome
