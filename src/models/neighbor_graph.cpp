#include "kinetome/models/neighbor_graph.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace kinetome {
namespace {

/// A graph put together frame after frame.
class GraphBuilder {
  public:
    void add_neighbour(int32_t frame, float distance) {
        neighbours_.push_back(frame);
        distances_.push_back(distance);
    }
    void end_frame() { offsets_.push_back(static_cast<int64_t>(neighbours_.size())); }
    NeighborGraph finish() {
        return {std::move(offsets_), std::move(neighbours_), std::move(distances_)};
    }

  private:
    std::vector<int64_t> offsets_{0};
    std::vector<int32_t> neighbours_;
    std::vector<float> distances_;
};

template <class Keep>
NeighborGraph filtered(const NeighborGraph& graph, const RowRange& frames, const Keep& keep) {
    GraphBuilder builder;
    for (int64_t i = frames.first; i < frames.end; ++i) {
        const auto neighbours = graph.neighbours(i);
        const auto distances = graph.distances(i);
        for (size_t e = 0; e < neighbours.size(); ++e) {
            if (keep(neighbours[e], distances[e])) {
                builder.add_neighbour(neighbours[e] - static_cast<int32_t>(frames.first),
                                      distances[e]);
            }
        }
        builder.end_frame();
    }
    return builder.finish();
}

/// Every edge turned round. Reading rows in order leaves the neighbours of each frame in order.
NeighborGraph transposed(const NeighborGraph& graph) {
    const auto frames = static_cast<size_t>(graph.frames());
    std::vector<int64_t> offsets(frames + 1, 0);
    for (const int32_t neighbour : graph.all_neighbours()) ++offsets[size_t(neighbour) + 1];
    std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
    std::vector<int64_t> next(offsets.begin(), offsets.end() - 1);
    std::vector<int32_t> neighbours(graph.all_neighbours().size());
    std::vector<float> distances(neighbours.size());
    for (int64_t i = 0; i < graph.frames(); ++i) {
        const auto to = graph.neighbours(i);
        for (size_t e = 0; e < to.size(); ++e) {
            const auto place = static_cast<size_t>(next[static_cast<size_t>(to[e])]++);
            neighbours[place] = static_cast<int32_t>(i);
            distances[place] = graph.distances(i)[e];
        }
    }
    return {std::move(offsets), std::move(neighbours), std::move(distances)};
}

}  // namespace

NeighborGraph::NeighborGraph(std::vector<int64_t> offsets, std::vector<int32_t> neighbours,
                             std::vector<float> distances)
    : offsets_(std::move(offsets)),
      neighbours_(std::move(neighbours)),
      distances_(std::move(distances)) {
    const auto refuse = [](const char* what) { throw std::invalid_argument(what); };
    if (offsets_.empty() || offsets_.front() != 0 ||
        offsets_.back() != static_cast<int64_t>(neighbours_.size()) ||
        neighbours_.size() != distances_.size() ||
        !std::is_sorted(offsets_.begin(), offsets_.end())) {
        refuse("the offsets of a neighbourhood graph do not fit its neighbours");
    }
    for (int64_t i = 0; i < frames(); ++i) {
        int64_t least = 0;
        for (const int32_t neighbour : this->neighbours(i)) {
            if (neighbour < least || neighbour >= frames()) {
                refuse("the neighbours of a frame do not ascend within the take");
            }
            least = int64_t{neighbour} + 1;
        }
    }
}

std::span<const int32_t> NeighborGraph::neighbours(int64_t frame) const {
    const auto first = static_cast<size_t>(offsets_[static_cast<size_t>(frame)]);
    const auto end = static_cast<size_t>(offsets_[static_cast<size_t>(frame) + 1]);
    return std::span(neighbours_).subspan(first, end - first);
}

std::span<const float> NeighborGraph::distances(int64_t frame) const {
    const auto first = static_cast<size_t>(offsets_[static_cast<size_t>(frame)]);
    const auto end = static_cast<size_t>(offsets_[static_cast<size_t>(frame) + 1]);
    return std::span(distances_).subspan(first, end - first);
}

bool NeighborGraph::has_edge(int64_t frame, int64_t neighbour) const {
    const auto list = neighbours(frame);
    return std::binary_search(list.begin(), list.end(), neighbour);
}

NeighborGraph neighbor_graph(const MatrixFView& features, const KnnOptions& options,
                             KnnEngine engine, int threads) {
    if (features.rows() == 0) return {};
    const NeighbourLists lists =
        KnnIndex(features, engine, threads).search(features, options, threads);
    GraphBuilder builder;
    std::vector<std::pair<int32_t, float>> edges;
    for (int64_t i = 0; i < lists.queries(); ++i) {
        edges.clear();
        const auto rows = lists.rows_of(i);
        for (size_t e = 0; e < rows.size(); ++e) {
            edges.emplace_back(rows[e], lists.distances_of(i)[e]);
        }
        std::sort(edges.begin(), edges.end());
        for (const auto& [row, distance] : edges) builder.add_neighbour(row, distance);
        builder.end_frame();
    }
    return builder.finish();
}

uint64_t neighbor_graph_bytes(int64_t frames, int64_t columns, const KnnOptions& options) {
    constexpr uint64_t copies_of_features = 4;  // the rows, the index with its boxes
    constexpr uint64_t copies_of_edges = 5;  // lists in parts and joined, the graph; as they grow
    const auto edges = static_cast<uint64_t>(std::min(frames, options.neighbours));
    return static_cast<uint64_t>(frames) *
           (copies_of_features * static_cast<uint64_t>(columns) * sizeof(float) +
            copies_of_edges * edges * (sizeof(int32_t) + sizeof(float)));
}

NeighborGraph within(const NeighborGraph& graph, double radius) {
    return filtered(graph, {0, graph.frames()},
                    [&](int32_t, float distance) { return double(distance) <= radius; });
}

NeighborGraph subgraph(const NeighborGraph& graph, const RowRange& frames) {
    if (frames.first < 0 || frames.end < frames.first || frames.end > graph.frames()) {
        throw std::invalid_argument("a subgraph's frames lie outside its take");
    }
    return filtered(graph, frames, [&](int32_t neighbour, float) {
        return neighbour >= frames.first && neighbour < frames.end;
    });
}

NeighborGraph symmetrised(const NeighborGraph& graph) {
    const NeighborGraph back = transposed(graph);
    GraphBuilder builder;
    for (int64_t i = 0; i < graph.frames(); ++i) {
        const auto to = graph.neighbours(i), from = back.neighbours(i);
        size_t a = 0, b = 0;
        while (a < to.size() || b < from.size()) {
            const bool take_to = b == from.size() || (a < to.size() && to[a] <= from[b]);
            const int32_t frame = take_to ? to[a] : from[b];
            builder.add_neighbour(frame, take_to ? graph.distances(i)[a] : back.distances(i)[b]);
            if (a < to.size() && to[a] == frame) ++a;
            if (b < from.size() && from[b] == frame) ++b;
        }
        builder.end_frame();
    }
    return builder.finish();
}

}  // namespace kinetome
