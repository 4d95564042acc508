// What numbers of the command line must be. CLI11's own checks tell the largest double, digit by
// digit.
#pragma once

#include <CLI/CLI.hpp>

namespace kinetome::cli {

const CLI::Validator& above_zero();
const CLI::Validator& zero_or_above();

}  // namespace kinetome::cli
