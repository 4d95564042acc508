#include "kinetome/store/json_text.h"

namespace kinetome {
namespace {

/// Bytes above 0x7F as two bytes of UTF-8, the code point being the byte's number.
std::string encode(const std::string& bytes) {
    std::string text;
    text.reserve(bytes.size());
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x80) {
            text += c;
        } else {
            text += static_cast<char>(0xC0 | (byte >> 6));
            text += static_cast<char>(0x80 | (byte & 0x3F));
        }
    }
    return text;
}

std::string decode(const std::string& text) {
    std::string bytes;
    bytes.reserve(text.size());
    for (size_t i = 0; i < text.size(); ++i) {
        const auto lead = static_cast<unsigned char>(text[i]);
        if (lead < 0x80 || i + 1 == text.size()) {
            bytes += text[i];
        } else {
            const auto next = static_cast<unsigned char>(text[++i]);
            bytes += static_cast<char>(((lead & 0x03) << 6) | (next & 0x3F));
        }
    }
    return bytes;
}

template <class Change>
Json change_texts(const Json& json, Change change) {
    if (json.is_string()) return change(json.get_ref<const std::string&>());
    Json result = json;
    if (json.is_object()) {
        result = Json::object();
        for (const auto& [key, value] : json.items()) {
            result[change(key)] = change_texts(value, change);
        }
    } else if (json.is_array()) {
        for (Json& value : result) value = change_texts(value, change);
    }
    return result;
}

}  // namespace

std::string dump_json(const Json& json, int indent) {
    return change_texts(json, encode).dump(indent);
}

Json parse_json(std::string_view text, const std::filesystem::path& path, std::string_view what) {
    return convert_json(Json(), path, what,
                        [&](const Json&) { return change_texts(Json::parse(text), decode); });
}

}  // namespace kinetome
