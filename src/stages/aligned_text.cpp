#include "kinetome/stages/aligned_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "kinetome/base/quote.h"

namespace kinetome {
namespace {

std::string cell_text(const Table::Cell& cell) {
    if (const auto* text = std::get_if<std::string>(&cell)) return path_for_message(*text);
    if (const auto* whole = std::get_if<int64_t>(&cell)) return fmt::format("{}", *whole);
    return fmt::format("{:.3f}", std::get<double>(cell));
}

/// Characters of a text in UTF-8.
size_t width_of(const std::string& text) {
    return static_cast<size_t>(
        std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xc0) != 0x80; }));
}

}  // namespace

std::string aligned_text(const Table& table) {
    std::vector<std::vector<std::string>> lines = {table.columns};
    for (const auto& row : table.rows) {
        std::vector<std::string>& line = lines.emplace_back();
        for (const Table::Cell& cell : row) line.push_back(cell_text(cell));
    }
    std::vector<size_t> widths(table.columns.size(), 0);
    for (const auto& line : lines) {
        for (size_t c = 0; c < line.size(); ++c) {
            widths[c] = std::max(widths[c], width_of(line[c]));
        }
    }
    std::string text;
    for (const auto& line : lines) {
        for (size_t c = 0; c < line.size(); ++c) {
            const std::string padding(widths[c] - width_of(line[c]), ' ');
            if (c == 0) {
                text += line[c] + (line.size() > 1 ? padding : "");
            } else {
                text += "  " + padding + line[c];
            }
        }
        text += '\n';
    }
    return text;
}

}  // namespace kinetome
