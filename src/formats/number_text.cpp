#include "kinetome/formats/number_text.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <stdexcept>

namespace kinetome {
namespace {

constexpr std::array<char, 200> digit_pairs = [] {
    std::array<char, 200> pairs{};
    for (size_t i = 0; i < 100; ++i) {
        pairs[2 * i] = static_cast<char>('0' + i / 10);
        pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
    }
    return pairs;
}();

/// Writes the digits of `number` before `end`, at least `least` of them; returns their beginning.
char* write_digits_before(char* end, uint64_t number, int least) {
    char* at = end;
    while (number >= 100) {
        at -= 2;
        std::memcpy(at, &digit_pairs[2 * (number % 100)], 2);
        number /= 100;
    }
    if (number >= 10) {
        at -= 2;
        std::memcpy(at, &digit_pairs[2 * number], 2);
    } else if (number > 0) {
        *--at = static_cast<char>('0' + number);
    }
    while (end - at < least) *--at = '0';
    return at;
}

}  // namespace

void append_fixed(std::string& text, double value, int decimals) {
    if (!std::isfinite(value)) throw std::invalid_argument("a number to be written is not finite");
    if (decimals < 0 || decimals > 15) throw std::invalid_argument("decimals must be 0 to 15");

    const double scaled =
        std::nearbyint(std::abs(value) * number_text::powers_of_ten[static_cast<size_t>(decimals)]);
    constexpr double largest_exact_integer = 9007199254740992.0;
    if (scaled > largest_exact_integer) {
        fmt::format_to(std::back_inserter(text), "{:.{}f}", value, decimals);
        return;
    }
    if (value < 0 && scaled > 0) text += '-';

    std::array<char, 40> buffer;
    char* const end = buffer.data() + buffer.size();
    char* begin = write_digits_before(end, static_cast<uint64_t>(scaled), decimals + 1);
    if (decimals > 0) {
        const auto whole = static_cast<size_t>(end - begin - decimals);
        --begin;
        std::memmove(begin, begin + 1, whole);
        begin[whole] = '.';
    }
    text.append(begin, end);
}

void append_integer(std::string& text, int64_t value) {
    fmt::format_to(std::back_inserter(text), "{}", value);
}

}  // namespace kinetome
