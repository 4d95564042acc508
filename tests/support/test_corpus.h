// Real takes for tests: the unpacked corpus that KINETOME_TEST_CORPUS names. Without it the tests
// that need it are skipped, and say so.
#pragma once

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <optional>

/// The unpacked corpus; nothing, after a warning that is printed, when the variable is not set.
inline std::optional<std::filesystem::path> test_corpus() {
    if (const char* const folder = std::getenv("KINETOME_TEST_CORPUS"); folder && *folder)
        return std::filesystem::path(folder);
    WARN("SKIPPED: KINETOME_TEST_CORPUS not set");
    return std::nullopt;
}
