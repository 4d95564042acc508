// Numbers from text and back, quicker than the standard library and exact where it is.
#pragma once

#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace kinetome {

namespace number_text {

inline constexpr std::array<double, 23> powers_of_ten = {
    1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

inline constexpr std::array<uint64_t, 9> whole_powers_of_ten = {
    1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};

constexpr bool is_digit(char character) {
    return character >= '0' && character <= '9';
}

/// Appends the digits at `at` to `digits`, which wraps when there are more than 19; returns where
/// they end. Eight at a time without a branch for each: lengths of numbers are hard to predict.
inline const char* append_digits(const char* at, const char* last, uint64_t& digits) {
    static_assert(std::endian::native == std::endian::little);
    while (last - at >= 8) {
        uint64_t bytes;
        std::memcpy(&bytes, at, 8);
        bytes ^= 0x3030303030303030;  // a digit becomes its value, anything else more than 9
        const uint64_t others = (bytes | (bytes + 0x7676767676767676)) & 0x8080808080808080;
        const auto count = static_cast<size_t>(std::countr_zero(others)) / 8;
        if (count == 0) return at;
        // Zeros before the digits, then pairs, fours and all eight are joined.
        bytes <<= 8 * (8 - count);
        bytes = bytes * 10 + (bytes >> 8);
        bytes = ((bytes & 0x000000FF000000FF) * (100 + (uint64_t{1000000} << 32)) +
                 ((bytes >> 16) & 0x000000FF000000FF) * (1 + (uint64_t{10000} << 32))) >>
                32;
        digits = digits * whole_powers_of_ten[count] + bytes;
        at += count;
        if (count < 8) return at;
    }
    while (at != last && is_digit(*at)) digits = digits * 10 + static_cast<uint64_t>(*at++ - '0');
    return at;
}

inline const char* parse_by_library(const char* first, const char* last, double& value) {
    const auto [end, error] = std::from_chars(first, last, value);
    return error == std::errc() ? end : nullptr;
}

}  // namespace number_text

/// Reads the longest number at `first`, as std::from_chars does and with its result to the last bit
/// ("inf" and "nan" count as numbers). Returns where it ends, or nullptr when there is none or it
/// does not fit a double.
///
/// Clinger's fast path (How to Read Floating Point Numbers Accurately, 1990): up to 2^53 the digits
/// are a double, up to 10^22 so is the power of ten, and one product or quotient of the two rounds
/// once. All else goes to the library.
inline const char* parse_number(const char* first, const char* last, double& value) {
    using number_text::is_digit;
    const char* at = first;
    const bool negative = at != last && *at == '-';
    at += negative;

    uint64_t digits = 0;  // wraps when there are more than 19: those go to the library
    const char* const digits_begin = at;
    while (at != last && is_digit(*at)) digits = digits * 10 + static_cast<uint64_t>(*at++ - '0');
    int64_t digit_count = at - digits_begin;
    int64_t power = 0;
    if (at != last && *at == '.') {
        const char* const fraction_begin = ++at;
        at = number_text::append_digits(at, last, digits);
        power = fraction_begin - at;
        digit_count -= power;
    }
    if (digit_count == 0 || digit_count > 19) {
        return number_text::parse_by_library(first, last, value);
    }

    if (at != last && (*at == 'e' || *at == 'E')) {
        const char* digit = at + 1;
        const bool down = digit != last && *digit == '-';
        if (digit != last && (*digit == '-' || *digit == '+')) ++digit;
        int64_t exponent = 0;
        const char* const exponent_begin = digit;
        while (digit != last && is_digit(*digit) && exponent < 1000)
            exponent = exponent * 10 + (*digit++ - '0');
        if (digit == exponent_begin || exponent >= 1000) {
            return number_text::parse_by_library(first, last, value);
        }
        power += down ? -exponent : exponent;
        at = digit;
    }
    if (digits > (uint64_t{1} << 53) || power < -22 || power > 22) {
        return number_text::parse_by_library(first, last, value);
    }

    const auto whole = static_cast<double>(digits);
    const double size = power < 0 ? whole / number_text::powers_of_ten[static_cast<size_t>(-power)]
                                  : whole * number_text::powers_of_ten[static_cast<size_t>(power)];
    value = negative ? -size : size;
    return at;
}

/// Appends `value` with a fixed number of decimals (0 to 15), never in exponent form, never "-0".
/// The digits are those of value·10^decimals, computed in double and rounded to the nearest
/// integer, ties to even: for values that came from a float, and up to 9 decimals, the digits
/// printf gives; for any other, within half a unit of the last place plus one rounding. Throws
/// std::invalid_argument when `value` is not finite.
void append_fixed(std::string& text, double value, int decimals);

/// Appends a whole number in decimal.
void append_integer(std::string& text, int64_t value);

}  // namespace kinetome
