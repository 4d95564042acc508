#include "kinetome/report/xml_text.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace kinetome {
namespace {

constexpr std::string_view replacement = "\xef\xbf\xbd";

unsigned char byte(std::string_view text, size_t i) {
    return static_cast<unsigned char>(text[i]);
}

/// Bytes of the UTF-8 sequence that such a byte begins; 0 when it begins none.
size_t sequence_length(unsigned char lead) {
    if (lead < 0x80) return 1;
    if (lead >= 0xc2 && lead < 0xe0) return 2;
    if (lead >= 0xe0 && lead < 0xf0) return 3;
    if (lead >= 0xf0 && lead < 0xf5) return 4;
    return 0;
}

bool allowed(uint32_t character, size_t length) {
    constexpr uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    if (character < least[length] || character > 0x10ffff) return false;
    if (character >= 0xd800 && character < 0xe000) return false;
    if (character == 0xfffe || character == 0xffff) return false;
    return character >= 0x20 || character == '\t' || character == '\n' || character == '\r';
}

/// Bytes of the character that a text begins with; 0 when XML has none like it.
size_t character_length(std::string_view text) {
    const size_t length = sequence_length(byte(text, 0));
    if (length == 0 || length > text.size()) return 0;
    uint32_t character = length == 1 ? byte(text, 0) : byte(text, 0) & (0xffU >> (length + 1));
    for (size_t i = 1; i < length; ++i) {
        if ((byte(text, i) & 0xc0) != 0x80) return 0;
        character = character << 6 | (byte(text, i) & 0x3fU);
    }
    return allowed(character, length) ? length : 0;
}

}  // namespace

std::string xml_text(std::string_view text) {
    std::string escaped;
    for (size_t i = 0; i < text.size();) {
        const size_t length = character_length(text.substr(i));
        switch (text[i]) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            case '\'':
                escaped += "&#39;";
                break;
            default:
                escaped += length ? text.substr(i, length) : replacement;
        }
        i += std::max<size_t>(length, 1);
    }
    return escaped;
}

}  // namespace kinetome
