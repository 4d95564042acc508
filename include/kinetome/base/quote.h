// Text from a file, made fit to be shown: a hostile name must not write escape codes to a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kinetome {

/// `text` in single quotes. Bytes other than printable ASCII, quotes and backslashes become \xNN;
/// what exceeds `longest` bytes is cut and replaced by "...".
std::string quote_for_message(std::string_view text, size_t longest = 40);

/// A path as it is shown: whole and without quotes; control characters, backslashes and bytes that
/// are no UTF-8 become \\xNN.
std::string path_for_message(std::string_view path);

}  // namespace kinetome
