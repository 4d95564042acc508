#include "kinetome/base/quote.h"

namespace kinetome {

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

}  // namespace kinetome
