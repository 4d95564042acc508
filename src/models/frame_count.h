// Durations as frames.
#pragma once

#include <cmath>
#include <cstdint>

namespace kinetome {

/// The whole number of frames nearest to `seconds`.
inline int64_t frame_count(double seconds, double rate) {
    return std::llround(seconds * rate);
}

}  // namespace kinetome
