// Comma-separated values as RFC 4180 has them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinetome {

/// Appends one line. Fields with commas, quotes or line breaks are quoted; lines end in "\n".
void append_csv_line(std::string& text, const std::vector<std::string>& fields);

/// A text as a field that no spreadsheet takes for a formula: prefixed by ' if it begins with one
/// of = + - @, a tab or a carriage return. The identity for all other text.
std::string csv_text(std::string_view text);

/// What csv_text made of a text, undone.
std::string from_csv_text(std::string_view field);

/// Records of a whole file; lines end in "\n" or "\r\n", empty lines are left out. Throws
/// InputError
/// ("path:line: ...") for a quote that is not closed or stands inside a bare field.
struct CsvRecord {
    int64_t line = 0;  ///< where it begins, counted from 1
    std::vector<std::string> fields;
};
std::vector<CsvRecord> parse_csv(std::string_view text, const std::string& path);

}  // namespace kinetome
