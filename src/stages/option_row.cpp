#include "option_row.h"

#include <sstream>
#include <stdexcept>

#include "joint_words.h"
#include "kinetome/base/error.h"

namespace kinetome {

void refuse_value(const std::string& name, const std::string& text, const std::string& wanted) {
    throw UsageError(fmt::format("{} = '{}': expected {}", name, text, wanted));
}

OptionRow text_option(std::string name, std::string stage, std::string& value, std::string help) {
    return {std::move(name),
            std::move(stage),
            OptionKind::text,
            std::move(help),
            [&value] { return value; },
            [&value](const std::string& text) { value = text; }};
}

OptionRow count_list(std::string name, std::string stage, std::vector<int64_t>& values,
                     std::string help) {
    return {name,
            std::move(stage),
            OptionKind::text,
            std::move(help),
            [&values] { return fmt::format("{}", fmt::join(values, ",")); },
            [&values, name](const std::string& text) {
                std::vector<int64_t> parsed;
                std::istringstream parts(text);
                for (std::string part; std::getline(parts, part, ',');) {
                    parsed.push_back(parse_number<int64_t>(name, part));
                }
                values = std::move(parsed);
            }};
}

OptionRow joint_list(std::string name, std::string stage, std::vector<JointRole>& joints,
                     std::string help) {
    help += fmt::format(" ({})", fmt::join(joint_words(), "|"));
    return {name,
            std::move(stage),
            OptionKind::text,
            std::move(help),
            [&joints] { return write_joints(joints); },
            [&joints, name](const std::string& text) {
                const auto parsed = parse_joints(text);
                if (!parsed) {
                    refuse_value(name, text,
                                 fmt::format("some of {}", fmt::join(joint_words(), ", ")));
                }
                joints = *parsed;
            }};
}

OptionRow spread_option(std::string name, std::string stage, MotionBundleOptions& bundles) {
    return {name,
            std::move(stage),
            OptionKind::text,
            "how far the similarity of substrings is spread from one to others (closure|"
            "closure-near|closure-length|depth:N)",
            [&bundles] { return spread_text(bundles); },
            [&bundles, name](const std::string& text) {
                try {
                    parse_spread(text, bundles);
                } catch (const std::invalid_argument&) {
                    refuse_value(name, text, "closure, closure-near, closure-length or depth:N");
                }
            }};
}

}  // namespace kinetome
