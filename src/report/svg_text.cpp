#include "svg_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace kinetome {

std::string svg_number(double value) {
    std::string text = fmt::format("{:.2f}", value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

double svg_text_width(std::string_view text) {
    constexpr double letter_width = 6.6;  // a generous mean of common sans-serif faces at 12 px
    const auto starts_character = [](char byte) { return (byte & 0xc0) != 0x80; };
    return letter_width * double(std::count_if(text.begin(), text.end(), starts_character));
}

}  // namespace kinetome
