#include "kinetome/base/environment.h"

#include <cstdlib>

namespace kinetome {

Environment environment_of_this_process() {
    return [](const std::string& name) -> std::optional<std::string> {
        const char* value = std::getenv(name.c_str());
        return value ? std::optional<std::string>(value) : std::nullopt;
    };
}

}  // namespace kinetome
