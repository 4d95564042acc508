// A string as JSON writes it (RFC 8259, section 7).
#pragma once

#include <string>
#include <string_view>

namespace kinetome {

/// Quoted and escaped; bytes that are not UTF-8 (file names may hold any) become U+FFFD.
std::string json_text(std::string_view text);

}  // namespace kinetome
