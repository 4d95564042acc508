// Where a command's text goes: to the file it was told, or to standard output.
#pragma once

#include <filesystem>
#include <string_view>

namespace kinetome::cli {

/// An empty path is standard output. Throws CreateError, and StoreError where standard output takes
/// no more; a reader of it that has seen enough (`| head`) is no error.
void write_text(const std::filesystem::path& output, std::string_view text);

/// Whatever was printed before; throws as write_text does.
void flush_output();

}  // namespace kinetome::cli
