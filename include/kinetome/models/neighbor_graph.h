// Which frames of a take have similar poses (S3 §3): the graph that activities, primitives and
// their clusters are read from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"
#include "kinetome/math/knn.h"

namespace kinetome {

/// Frame i of a take has neighbours [offsets[i], offsets[i + 1]), itself among them, in the order
/// of their frames. Directed: i may be among the k nearest of j and j not among those of i.
class NeighborGraph {
  public:
    NeighborGraph() = default;
    /// Throws std::invalid_argument unless offsets ascend from 0 to the number of neighbours and
    /// the neighbours of each frame ascend within [0, frames).
    NeighborGraph(std::vector<int64_t> offsets, std::vector<int32_t> neighbours,
                  std::vector<float> distances);

    int64_t frames() const { return static_cast<int64_t>(offsets_.size()) - 1; }
    std::span<const int32_t> neighbours(int64_t frame) const;
    std::span<const float> distances(int64_t frame) const;  ///< not squared, units of the features
    bool has_edge(int64_t frame, int64_t neighbour) const;

    const std::vector<int64_t>& offsets() const { return offsets_; }
    const std::vector<int32_t>& all_neighbours() const { return neighbours_; }
    const std::vector<float>& all_distances() const { return distances_; }

  private:
    std::vector<int64_t> offsets_{0};
    std::vector<int32_t> neighbours_;
    std::vector<float> distances_;
};

/// The graph of the n × d features of one take (S3 §3: 45 columns at 30 Hz, cm). Throws what
/// KnnIndex throws.
NeighborGraph neighbor_graph(const MatrixFView& features, const KnnOptions& options,
                             KnnEngine engine, int threads);

/// Memory that building the graph of n × columns features takes at most, itself and the features
/// counted.
uint64_t neighbor_graph_bytes(int64_t frames, int64_t columns, const KnnOptions& options);

/// The edges no longer than `radius`: the graph of that radius, since lists hold the nearest.
NeighborGraph within(const NeighborGraph& graph, double radius);

/// An edge wherever there is one in either direction.
NeighborGraph symmetrised(const NeighborGraph& graph);

/// The graph among the frames of a range, numbered from its first.
NeighborGraph subgraph(const NeighborGraph& graph, const RowRange& frames);

}  // namespace kinetome
