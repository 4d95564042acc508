#pragma once

#include <stdexcept>
#include <string>

/// `text` with its first `from` replaced; a test that would change nothing is a broken test.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("the text does not hold " + from);
    return text.replace(at, from.size(), to);
}
