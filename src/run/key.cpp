#include "kinetome/run/key.h"

#include <fmt/format.h>

#include <algorithm>

namespace kinetome {
namespace {

bool is_digest(const std::string& value) {
    return value.size() == 32 && value.find_first_not_of("0123456789abcdef") == std::string::npos;
}

std::string describe_change(const std::string& name, const std::string& was,
                            const std::string& is) {
    if (is_digest(was) && is_digest(is)) return name + " changed";
    return fmt::format("{} was {}, is {}", name, was, is);
}

}  // namespace

StageKey& StageKey::add(std::string name, std::string value) {
    parts_.emplace_back(std::move(name), std::move(value));
    return *this;
}

Digest StageKey::digest() const {
    Hasher hasher;
    for (const auto& [name, value] : parts_) hasher.text(name).text(value);
    return hasher.finish();
}

std::string StageKey::difference_from(const StageKey& earlier) const {
    const auto value_in = [](const StageKey& key, const std::string& name) -> const std::string* {
        const auto found = std::find_if(key.parts_.begin(), key.parts_.end(),
                                        [&](const Part& part) { return part.first == name; });
        return found == key.parts_.end() ? nullptr : &found->second;
    };
    std::vector<std::string> changes;
    for (const auto& [name, value] : parts_) {
        const std::string* was = value_in(earlier, name);
        if (!was) {
            changes.push_back(name + " is new");
        } else if (*was != value) {
            changes.push_back(describe_change(name, *was, value));
        }
    }
    for (const auto& [name, value] : earlier.parts_) {
        if (!value_in(*this, name)) changes.push_back(name + " is gone");
    }
    constexpr size_t shown = 3;
    const size_t more = changes.size() > shown ? changes.size() - shown : 0;
    changes.resize(changes.size() - more);
    std::string text = fmt::format("{}", fmt::join(changes, "; "));
    if (more) text += fmt::format("; and {} more", more);
    return text;
}

}  // namespace kinetome
