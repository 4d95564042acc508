#include "recurrence.h"

#include <algorithm>
#include <cmath>

namespace kinetome {
namespace {

bool holds(const RowRange& hold, int64_t frame) {
    return frame >= hold.first && frame < hold.end;
}

RowRange hold_of(const NeighborGraph& graph, int64_t frame, int64_t longest) {
    const auto neighbours = graph.neighbours(frame);
    const auto here = std::ranges::lower_bound(neighbours, frame);
    const auto later = here + (here != neighbours.end() && *here == frame);
    const int64_t most_before = std::min(longest, here - neighbours.begin());
    const int64_t most_after = std::min(longest, neighbours.end() - later);
    int64_t before = 0, after = 0;
    while (before < most_before && here[-1 - before] == frame - 1 - before) ++before;
    while (after < most_after && later[after] == frame + 1 + after) ++after;
    return {frame - before, frame + 1 + after};
}

/// Of a frame that meets another, by the lengths of their holds: the geometric mean makes up for
/// tempo. That of a rest is only how far we looked, not how slow it is.
double weight(int64_t hold, int64_t other, int64_t rest) {
    const int64_t longer = std::max(hold, other);
    return longer < rest ? 1 / std::sqrt(double(hold) * double(other)) : 1 / double(longer);
}

}  // namespace

Recurrence recurrence(const NeighborGraph& graph, int64_t longest_hold) {
    const NeighborGraph similar = symmetrised(graph);
    const int64_t rest = 2 * longest_hold + 1;
    std::vector<RowRange> hold;
    Recurrence result;
    for (int64_t i = 0; i < similar.frames(); ++i) {
        hold.push_back(hold_of(similar, i, longest_hold));
        result.hold.push_back(static_cast<int32_t>(hold.back().size()));
    }
    for (int64_t i = 0; i < similar.frames(); ++i) {
        const RowRange& own = hold[static_cast<size_t>(i)];
        for (const int32_t j : similar.neighbours(i)) {
            const RowRange& other = hold[static_cast<size_t>(j)];
            if (holds(own, j) || holds(other, i)) continue;
            result.frames.push_back(j);
            result.weights.push_back(weight(own.size(), other.size(), rest));
        }
        result.offsets.push_back(static_cast<int64_t>(result.frames.size()));
    }
    return result;
}

}  // namespace kinetome
