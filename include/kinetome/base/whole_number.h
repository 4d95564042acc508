// Numbers as other programs write them, in files and environment variables.
#pragma once

#include <charconv>
#include <concepts>
#include <optional>
#include <string_view>

namespace kinetome {

/// The number `text` consists of; nothing when there is anything else in it, or too many digits.
template <std::integral Number>
std::optional<Number> whole_number(std::string_view text) {
    Number value{};
    const char* end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stopped != end) return std::nullopt;
    return value;
}

}  // namespace kinetome
