// Where a command's text goes: to the file it was told, or to standard output.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "kinetome/base/file_writer.h"

namespace kinetome::cli {

/// An empty path is standard output. Throws CreateError, and StoreError where standard output takes
/// no more; a reader of it that has seen enough (`| head`) is no error.
void write_text(const std::filesystem::path& output, std::string_view text);

/// The same of a text that is written as it is made, by handing it over piece by piece. Where a
/// reader has seen enough, it throws std::system_error (broken pipe): nothing more is needed.
void write_text(const std::filesystem::path& output,
                const std::function<void(const TakeText&)>& write);

/// Whatever was printed before; throws as write_text does.
void flush_output();

}  // namespace kinetome::cli
