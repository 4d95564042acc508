// Numbers and words in SVG pictures.
#pragma once

#include <string>
#include <string_view>

namespace kinetome {

/// The typeface that svg_text_width() knows, for the outermost element.
constexpr std::string_view svg_font =
    R"svg(font-family="Helvetica, Arial, 'DejaVu Sans', sans-serif" font-size="12")svg";

/// Two decimals at most, none of them a trailing zero.
std::string svg_number(double value);

/// Of UTF-8 in svg_font, pixels: generous.
double svg_text_width(std::string_view text);

}  // namespace kinetome
