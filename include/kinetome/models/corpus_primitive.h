// Primitives of many clips side by side.
#pragma once

#include <cstdint>

#include "kinetome/base/pieces.h"

namespace kinetome {

/// A primitive among the features of a corpus: one matrix, in which the frames of a clip follow
/// each other. Primitives are listed by clip, those of a clip in the order of their frames.
struct CorpusPrimitive {
    int64_t clip = 0;
    RowRange rows;  ///< of the matrix
    bool operator==(const CorpusPrimitive&) const = default;
};

/// Whether the second begins in the frame in which the first ends.
inline bool adjoin(const CorpusPrimitive& first, const CorpusPrimitive& second) {
    return first.clip == second.clip && first.rows.end == second.rows.first;
}

}  // namespace kinetome
