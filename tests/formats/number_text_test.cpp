#include "kinetome/formats/number_text.h"

#include <bit>
#include <catch2/catch.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <string_view>

using namespace kinetome;

namespace {

/// Where the number ends and its bits, or -1 where there is none.
struct Parsed {
    std::ptrdiff_t length = -1;
    uint64_t bits = 0;
    bool operator==(const Parsed&) const = default;
};

Parsed parsed_here(std::string_view text) {
    double value = 0;
    const char* const end = parse_number(text.data(), text.data() + text.size(), value);
    if (end == nullptr) return {};
    return {end - text.data(), std::bit_cast<uint64_t>(value)};
}

Parsed parsed_by_library(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) return {};
    return {end - text.data(), std::bit_cast<uint64_t>(value)};
}

std::string random_number(std::mt19937& random) {
    const auto digits = [&](unsigned most) {
        std::string text;
        for (auto left = random() % (most + 1); left > 0; --left) {
            text += static_cast<char>('0' + random() % 10);
        }
        return text;
    };
    std::string text = random() % 2 ? "-" : "";
    text += digits(random() % 8 == 0 ? 22 : 4);
    if (random() % 4) text += "." + digits(random() % 8 == 0 ? 24 : 9);
    if (random() % 3 == 0) {
        text += random() % 2 ? "e" : "E";
        if (random() % 2) text += random() % 2 ? "-" : "+";
        text += digits(3);
    }
    if (random() % 4 == 0) text += " 12";
    if (random() % 4 == 0) text += "\n";
    return text;
}

std::string fixed(double value, int decimals) {
    std::string text;
    append_fixed(text, value, decimals);
    return text;
}

std::string printed(double value, int decimals) {
    char buffer[400];
    std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
    return buffer;
}

}  // namespace

TEST_CASE("a parsed number has the bits and the length std::from_chars gives") {
    for (const std::string_view text : {"0",
                                        "-0",
                                        "1",
                                        "-17.25",
                                        "1.39149e-015",
                                        "7.62852e-016",
                                        "9007199254740993",
                                        "1e22",
                                        "1e23",
                                        "-1e-22",
                                        "1e-23",
                                        "0.1",
                                        ".5",
                                        "5.",
                                        "-.5",
                                        "1e",
                                        "1e+",
                                        "1e-",
                                        "1.5e5x",
                                        "",
                                        "-",
                                        ".",
                                        "-.",
                                        "e5",
                                        "+1",
                                        "inf",
                                        "-inf",
                                        "nan",
                                        "0x10",
                                        "1_000",
                                        "1,5",
                                        "12345678",
                                        "123456789",
                                        "0.12345678",
                                        "0.123456789",
                                        "0.1234567890123456789",
                                        "1e400",
                                        "1e-400",
                                        "1e99999999999999999999",
                                        "00000000000000000000001",
                                        "4.9e-324",
                                        "1.7976931348623157e308",
                                        "1 2",
                                        "1\n2",
                                        "1\r\n",
                                        "1/2",
                                        "1:2"}) {
        INFO(text);
        CHECK(parsed_here(text) == parsed_by_library(text));
    }
}

TEST_CASE("no random text makes the fast path and std::from_chars disagree") {
    std::mt19937 random(7);
    for (int i = 0; i < 200000; ++i) {
        const std::string text = random_number(random);
        if (parsed_here(text) == parsed_by_library(text)) continue;
        FAIL(text);
    }
}

TEST_CASE("a number is never read beyond the end of its text") {
    const std::string text = "1234567890.123456789e-12";
    for (size_t length = 0; length <= text.size(); ++length) {
        const std::string cut = text.substr(0, length);  // of its own, so that a sanitizer sees
        CHECK(parsed_here(cut) == parsed_by_library(cut));
    }
}

TEST_CASE("a float is written with the digits printf gives") {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> size(-400, 400);
    for (int i = 0; i < 100000; ++i) {
        const auto value = static_cast<double>(size(random));
        const int decimals = i % 8;
        const std::string text = fixed(value, decimals);
        const std::string expected = printed(value, decimals);
        if (text == expected || "-" + text == expected) continue;  // "-0.00" is written "0.00"
        FAIL(text << " for " << expected);
    }
}

TEST_CASE("any double is written to within half a unit of the last place") {
    std::mt19937 random(13);
    std::uniform_real_distribution<double> exponent(-8, 9);
    for (int i = 0; i < 100000; ++i) {
        const double value = std::pow(10, exponent(random)) * (random() % 2 ? 1 : -1);
        const int decimals = i % 7;
        const double unit = std::pow(10.0, -decimals);
        const double rounding = std::abs(value) * std::numeric_limits<double>::epsilon();
        if (std::abs(std::stod(fixed(value, decimals)) - value) <= 0.5 * unit + rounding) continue;
        FAIL(fixed(value, decimals) << " for " << value);
    }
}

TEST_CASE("ties, carries, zeros and sizes beyond 2^53 are written right") {
    CHECK(fixed(0, 0) == "0");
    CHECK(fixed(0, 5) == "0.00000");
    CHECK(fixed(-0.0, 2) == "0.00");
    CHECK(fixed(-0.001, 2) == "0.00");
    CHECK(fixed(0.5, 0) == "0");
    CHECK(fixed(1.5, 0) == "2");
    CHECK(fixed(0.125, 2) == "0.12");
    CHECK(fixed(-9.999, 2) == "-10.00");
    CHECK(fixed(100, 2) == "100.00");
    CHECK(fixed(12345.678, 3) == "12345.678");
    CHECK(fixed(1e20, 3) == "100000000000000000000.000");
    CHECK(fixed(-1e17, 0) == "-100000000000000000");
}

TEST_CASE("a number that is not finite is refused, not written") {
    std::string text;
    CHECK_THROWS_AS(append_fixed(text, std::nan(""), 3), std::invalid_argument);
    CHECK_THROWS_AS(append_fixed(text, HUGE_VAL, 3), std::invalid_argument);
    CHECK_THROWS_AS(append_fixed(text, 1, 16), std::invalid_argument);
    CHECK(text.empty());
}
