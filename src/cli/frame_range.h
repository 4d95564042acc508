// A range of frames on the command line.
#pragma once

#include <string>

#include "kinetome/base/pieces.h"

namespace kinetome::cli {

/// "A:B": frames from A to before B. Throws UsageError unless 0 <= A < B.
RowRange parse_frame_range(const std::string& text);

}  // namespace kinetome::cli
