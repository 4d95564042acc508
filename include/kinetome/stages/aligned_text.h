// A table to be read on a terminal.
#pragma once

#include <string>

#include "kinetome/stages/export.h"

namespace kinetome {

/// A line a row, columns two spaces apart: the first one flush left, the others flush right,
/// numbers with three decimals. Control characters are shown, not sent.
std::string aligned_text(const Table& table);

}  // namespace kinetome
