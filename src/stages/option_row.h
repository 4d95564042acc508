// Rows of the table of options, one function a type of value: its text, and back.
#pragma once

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <string>
#include <utility>
#include <vector>

#include "kinetome/stages/options.h"

namespace kinetome {

/// Throws UsageError: what was wanted instead of the text.
[[noreturn]] void refuse_value(const std::string& name, const std::string& text,
                               const std::string& wanted);

template <class T>
requires(std::integral<T> || std::floating_point<T>) T
    parse_number(const std::string& name, const std::string& text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
        refuse_value(name, text, std::integral<T> ? "a whole number" : "a number");
    }
    if constexpr (std::floating_point<T>) {
        if (!std::isfinite(value)) refuse_value(name, text, "a finite number");
    }
    return value;
}

template <class T>
OptionRow number(std::string name, std::string stage, T& value, std::string help) {
    return {name,
            std::move(stage),
            OptionKind::number,
            std::move(help),
            [&value] { return fmt::format("{}", value); },
            [&value, name](const std::string& text) { value = parse_number<T>(name, text); }};
}

template <class E, size_t n>
OptionRow choice(std::string name, std::string stage, E& value,
                 const std::array<std::pair<const char*, E>, n>& names, std::string help) {
    std::vector<std::string> all;
    for (const auto& [text, one] : names) all.emplace_back(text);
    help += fmt::format(" ({})", fmt::join(all, "|"));
    return {name,
            std::move(stage),
            OptionKind::text,
            std::move(help),
            [&value, names] {
                for (const auto& [text, one] : names) {
                    if (one == value) return std::string(text);
                }
                return std::string();
            },
            [&value, names, name, all](const std::string& text) {
                for (const auto& [known, one] : names) {
                    if (text == known) {
                        value = one;
                        return;
                    }
                }
                refuse_value(name, text, fmt::format("one of {}", fmt::join(all, ", ")));
            }};
}

OptionRow text_option(std::string name, std::string stage, std::string& value, std::string help);

/// Whole numbers, separated by commas.
OptionRow count_list(std::string name, std::string stage, std::vector<int64_t>& values,
                     std::string help);

/// Words for groups of joints, separated by commas.
OptionRow joint_list(std::string name, std::string stage, std::vector<JointRole>& joints,
                     std::string help);

/// How far bundles spread the similarity of substrings: its rule, with a depth where it has one.
OptionRow spread_option(std::string name, std::string stage, MotionBundleOptions& bundles);

}  // namespace kinetome
