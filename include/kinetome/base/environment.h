// Variables of the environment, which tests replace.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace kinetome {

/// The value of a variable; nothing when it is not set.
using Environment = std::function<std::optional<std::string>(const std::string& name)>;

Environment environment_of_this_process();

}  // namespace kinetome
