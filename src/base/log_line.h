// How a log line looks: timed text, or one JSON object.
#pragma once

#include <spdlog/formatter.h>

#include <memory>

#include "kinetome/base/log.h"

namespace kinetome {

/// `before` goes in front of each line: on a terminal, what wipes a progress bar out.
std::unique_ptr<spdlog::formatter> line_formatter(LogFormat format, std::string before = {});

}  // namespace kinetome
