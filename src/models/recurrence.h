// Which frames of a take recur, and how much that counts.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/models/neighbor_graph.h"

namespace kinetome {

/// A symmetric sparse matrix of weights: the neighbours of each frame but those that are similar
/// to it for being near in time. However slow or fast a movement is, a frame that meets it again
/// once gets about 1 in all. Who passes through the pose of a rest, which has no tempo, meets it
/// once, however long it is.
struct Recurrence {
    std::vector<int64_t> offsets{0};  ///< of frame i: [offsets[i], offsets[i + 1])
    std::vector<int32_t> frames;      ///< ascending
    std::vector<double> weights;
    std::vector<int32_t> hold;  ///< frames around i that stay similar to it, itself among them

    int64_t size() const { return static_cast<int64_t>(hold.size()); }
    std::span<const int32_t> frames_of(int64_t i) const { return part(frames, i); }
    std::span<const double> weights_of(int64_t i) const { return part(weights, i); }

  private:
    template <class Value>
    std::span<const Value> part(const std::vector<Value>& values, int64_t i) const {
        const auto first = static_cast<size_t>(offsets[static_cast<size_t>(i)]);
        const auto end = static_cast<size_t>(offsets[static_cast<size_t>(i) + 1]);
        return std::span(values).subspan(first, end - first);
    }
};

/// The hold of a frame reaches through consecutive neighbours, at most `longest_hold` frames to
/// each side; where it reaches as far as that on both, the frame rests. Removing holds leaves the
/// anti-diagonals of a movement that runs back the way it came where a component's removal takes
/// them along.
Recurrence recurrence(const NeighborGraph& graph, int64_t longest_hold);

}  // namespace kinetome
