// How the stores of features and of neighbours write what belongs to a class.
#pragma once

#include <span>
#include <string>

namespace kinetome {

inline std::string at(const std::string& clip_class, const std::string& what) {
    return "/" + clip_class + "/" + what;
}

/// A value as a row of its own.
template <class T>
std::span<const T> one(const T& value) {
    return {&value, 1};
}

}  // namespace kinetome
