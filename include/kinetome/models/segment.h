// What a take is cut into (S3 §4–5). Frames count at the rate of the neighbourhood graph.
#pragma once

#include <cstdint>

#include "kinetome/base/pieces.h"

namespace kinetome {

enum class SegmentKind { activity, transition };

/// Segments of a take follow each other without gaps.
struct Segment {
    RowRange frames;
    SegmentKind kind = SegmentKind::activity;
    int32_t cluster =
        -1;  ///< activities of a take that are the same share it, from 0; -1: transition
    bool operator==(const Segment&) const = default;
};

/// One execution of the movement that an activity repeats (S3 §5).
struct Primitive {
    RowRange frames;
    int32_t activity = -1;  ///< the segment it lies in, by its number in the take
    bool operator==(const Primitive&) const = default;
};

}  // namespace kinetome
