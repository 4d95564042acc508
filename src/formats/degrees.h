#pragma once

#include <numbers>

namespace kinetome {

inline constexpr double degrees_per_radian = 180.0 / std::numbers::pi;

}  // namespace kinetome
