#include "json_text.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>

namespace kinetome {
namespace {

/// Bytes of the well-formed UTF-8 sequence that `text` begins with (Unicode, table 3-7); 0 if none.
size_t sequence_length(std::string_view text) {
    const auto byte = [text](size_t i) -> uint8_t {
        return i < text.size() ? static_cast<uint8_t>(text[i]) : 0;
    };
    const auto continues = [&](size_t i) { return (byte(i) & 0xC0) == 0x80; };
    const uint8_t lead = byte(0), second = byte(1);
    if (lead < 0x80) return 1;
    if (lead >= 0xC2 && lead <= 0xDF) return continues(1) ? 2 : 0;
    if (lead >= 0xE0 && lead <= 0xEF) {
        const bool overlong = lead == 0xE0 && second < 0xA0;
        const bool surrogate = lead == 0xED && second > 0x9F;
        return continues(1) && continues(2) && !overlong && !surrogate ? 3 : 0;
    }
    if (lead >= 0xF0 && lead <= 0xF4) {
        const bool overlong = lead == 0xF0 && second < 0x90;
        const bool too_large = lead == 0xF4 && second > 0x8F;
        return continues(1) && continues(2) && continues(3) && !overlong && !too_large ? 4 : 0;
    }
    return 0;
}

void append_ascii(std::string& json, char character) {
    switch (character) {
        case '"':
            json += "\\\"";
            return;
        case '\\':
            json += "\\\\";
            return;
        case '\n':
            json += "\\n";
            return;
        case '\r':
            json += "\\r";
            return;
        case '\t':
            json += "\\t";
            return;
        default:
            break;
    }
    const auto code = static_cast<uint8_t>(character);
    if (code < 0x20 || code == 0x7F) {
        json += fmt::format("\\u{:04x}", code);
    } else {
        json += character;
    }
}

}  // namespace

std::string json_text(std::string_view text) {
    std::string json = "\"";
    while (!text.empty()) {
        const size_t length = sequence_length(text);
        if (length == 0) {
            json += "\xEF\xBF\xBD";
        } else if (length == 1) {
            append_ascii(json, text.front());
        } else {
            json.append(text.substr(0, length));
        }
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return json + '"';
}

}  // namespace kinetome
