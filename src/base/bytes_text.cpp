#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "kinetome/base/error.h"
#include "kinetome/base/resources.h"
#include "kinetome/base/whole_number.h"
#include "wide_integer.h"

namespace kinetome {
namespace {

constexpr std::string_view unit_letters = "KMGTP";

UsageError not_bytes(std::string_view text) {
    return UsageError(fmt::format(
        "'{}' is not an amount of memory: write for example 8G, 512M, 1.5GiB or 65536", text));
}

std::string_view without_spaces_around(std::string_view text) {
    const auto space = [](char c) { return c == ' ' || c == '\t'; };
    while (!text.empty() && space(text.front())) text.remove_prefix(1);
    while (!text.empty() && space(text.back())) text.remove_suffix(1);
    return text;
}

/// Of "", "B", "G", "GB" or "GiB", in any case: log2 of the unit.
std::optional<int> unit_shift(std::string_view unit) {
    std::string upper;
    for (const char c : unit) upper += static_cast<char>(std::toupper(static_cast<uint8_t>(c)));
    if (upper.empty() || upper == "B") return 0;
    const size_t letter = unit_letters.find(upper.front());
    if (letter == std::string_view::npos) return std::nullopt;
    const std::string rest = upper.substr(1);
    if (!rest.empty() && rest != "B" && rest != "IB") return std::nullopt;
    return 10 * (static_cast<int>(letter) + 1);
}

/// 10^digits, for a fraction that the wide integer can hold.
std::optional<uint64_t> power_of_ten(size_t digits) {
    if (digits > 18) return std::nullopt;
    uint64_t power = 1;
    for (size_t i = 0; i < digits; ++i) power *= 10;
    return power;
}

}  // namespace

uint64_t parse_bytes(std::string_view text) {
    const std::string_view amount = without_spaces_around(text);
    const size_t number_end = std::min(amount.find_first_not_of("0123456789."), amount.size());
    const std::string_view number = amount.substr(0, number_end);
    const auto shift = unit_shift(without_spaces_around(amount.substr(number_end)));
    const size_t point = number.find('.');
    const auto whole = whole_number<uint64_t>(number.substr(0, point));
    if (!shift || !whole) throw not_bytes(text);

    WideUnsigned bytes = WideUnsigned{*whole} << *shift;
    if (point != std::string_view::npos) {
        const std::string_view digits = number.substr(point + 1);
        const auto fraction = whole_number<uint64_t>(digits);
        const auto denominator = power_of_ten(digits.size());
        if (!fraction || !denominator || *shift == 0) throw not_bytes(text);
        bytes += (WideUnsigned{*fraction} << *shift) / *denominator;
    }
    if (bytes > std::numeric_limits<uint64_t>::max()) throw not_bytes(text);
    return static_cast<uint64_t>(bytes);
}

std::string describe_bytes(uint64_t bytes) {
    if (bytes < 1024) return fmt::format("{} bytes", bytes);
    double scaled = static_cast<double>(bytes) / 1024;
    size_t unit = 0;
    // 1023.995 would print as 1024.00
    while (scaled >= 1023.995 && unit + 1 < unit_letters.size()) {
        scaled /= 1024;
        ++unit;
    }
    return fmt::format("{:.2f} {}iB ({} bytes)", scaled, unit_letters[unit], bytes);
}

}  // namespace kinetome
