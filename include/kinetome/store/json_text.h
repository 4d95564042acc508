// JSON of texts that need not be UTF-8: names of files are any bytes.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "kinetome/base/error.h"

namespace kinetome {

/// Keeps the order in which members were put.
using Json = nlohmann::ordered_json;

/// JSON text in which every byte above 0x7F stands as the code point of its number (U+0080 to
/// U+00FF): ASCII stays readable and nothing is lost. `indent` as in nlohmann's dump().
std::string dump_json(const Json& json, int indent);

/// Back from dump_json. Throws StoreError: "<path>: not <what>: <reason>".
Json parse_json(std::string_view text, const std::filesystem::path& path, std::string_view what);

/// Runs `convert(json)`; a member that is missing or of another type becomes the same StoreError.
template <class Convert>
auto convert_json(const Json& json, const std::filesystem::path& path, std::string_view what,
                  Convert convert) {
    try {
        return convert(json);
    } catch (const nlohmann::json::exception& error) {
        throw DamagedError(path.string() + ": not " + std::string(what) + ": " + error.what());
    }
}

}  // namespace kinetome
