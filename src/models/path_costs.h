// How much alike the surroundings of two frames are, however fast each goes.
#pragma once

#include <algorithm>

#include "frame_distances.h"

namespace kinetome {

/// For each pair of a frame of `rows` and any frame: the mean distance along the best warping path
/// through the pair, `side` steps of (1, 1), (1, 2) or (2, 1) long on either side of it. Both
/// frames go forward on it, neither more than twice as fast as the other: a movement that runs back
/// the way it came does not match itself. At the first and last frame a path stays where it is.
MatrixF path_costs(const FrameDistances& distances, const RowRange& rows, int64_t side);

/// Calls visit(frame, costs) for each frame in order, with its path costs to all; few rows are held
/// at a time.
template <class Visit>
void for_each_cost_row(const FrameDistances& distances, int64_t side, const Visit& visit) {
    constexpr int64_t rows_at_once = 128;
    for (int64_t first = 0; first < distances.size(); first += rows_at_once) {
        const int64_t end = std::min(first + rows_at_once, distances.size());
        const MatrixF costs = path_costs(distances, {first, end}, side);
        for (int64_t i = first; i < end; ++i) visit(i, costs.row(i - first));
    }
}

}  // namespace kinetome
