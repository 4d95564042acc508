// Where a command's text goes: to the file it was told, or to standard output.
#pragma once

#include <filesystem>
#include <string_view>

namespace kinetome::cli {

/// An empty path is standard output, which main flushes and checks. Throws CreateError.
void write_text(const std::filesystem::path& output, std::string_view text);

}  // namespace kinetome::cli
