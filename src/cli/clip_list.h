// Clips named on the command line, whose names may hold commas themselves.
#pragma once

#include <string>
#include <vector>

#include "kinetome/store/catalog.h"

namespace kinetome::cli {

/// The names in `words`, separated by commas; a word that is the name of a clip is that one name.
std::vector<std::string> listed_clips(const std::vector<std::string>& words,
                                      const Catalog& catalog);

}  // namespace kinetome::cli
