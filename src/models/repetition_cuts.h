// The cuts with which frames recur most inside segments.
#pragma once

#include <vector>

#include "kinetome/base/pieces.h"
#include "recurrence.h"

namespace kinetome {

struct ScoredSegment {
    RowRange frames;
    double repetitions = 0;  ///< weight that recurs inside, a frame: about one less than cycles
};

/// Of all ways to cut a take, the one that maximises the sum of repetitions - segment_cost over its
/// segments; of equal ones, the one whose last segments are longest. A homogeneous activity loses
/// about 1 when it is cut, two different ones lose as much when they are joined: no number of
/// segments needs to be given. O(n²) time, O(n + edges) memory.
std::vector<ScoredSegment> repetition_cuts(const Recurrence& recurrence, double segment_cost);

}  // namespace kinetome
