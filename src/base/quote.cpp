#include "kinetome/base/quote.h"

#include <fmt/format.h>

#include <algorithm>

namespace kinetome {
namespace {

/// Bytes of the printable character that a text begins with; 0 when it begins with none.
size_t printable_length(std::string_view text) {
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
    if (byte(0) < 0x80) return byte(0) >= 0x20 && byte(0) != 0x7f && byte(0) != '\\' ? 1 : 0;
    const size_t length = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
    if (byte(0) < 0xc2 || byte(0) > 0xf4 || text.size() < length) return 0;
    for (size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return 0;
    }
    // U+0080 to U+009F are controls too, and some terminals obey them.
    return byte(0) == 0xc2 && byte(1) < 0xa0 ? 0 : length;
}

}  // namespace

std::string quote_for_message(std::string_view text, size_t longest) {
    constexpr std::string_view hexadecimal = "0123456789abcdef";
    std::string quoted = "'";
    for (const char character : text.substr(0, longest)) {
        const auto byte = static_cast<unsigned char>(character);
        if (byte >= 0x20 && byte < 0x7f && character != '\'' && character != '\\') {
            quoted += character;
        } else {
            quoted += "\\x";
            quoted += hexadecimal[byte >> 4];
            quoted += hexadecimal[byte & 0xf];
        }
    }
    if (text.size() > longest) quoted += "...";
    return quoted + "'";
}

std::string path_for_message(std::string_view path) {
    std::string text;
    for (size_t i = 0; i < path.size();) {
        const size_t length = printable_length(path.substr(i));
        if (length) {
            text += path.substr(i, length);
        } else {
            text += fmt::format("\\x{:02x}", static_cast<unsigned char>(path[i]));
        }
        i += std::max<size_t>(length, 1);
    }
    return text;
}

}  // namespace kinetome
