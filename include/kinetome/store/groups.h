// What an artifact holds once for each class or partition lies in a group of that name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinetome/store/artifact.h"

namespace kinetome {

/// The paths, such as "/walkers", of the groups that hold `dataset`, such as "/clips/name": in
/// their order in the file.
std::vector<std::string> groups_with(const ArtifactReader& file, std::string_view dataset);

}  // namespace kinetome
