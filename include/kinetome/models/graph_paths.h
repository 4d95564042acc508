// Warping paths in a neighbourhood graph (S3 §3, after Krüger et al. 2010): an edge from frame i to
// its neighbour j is a cell (i, j) of the take's self-similarity matrix, and cells that a step of a
// warping path joins belong together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/models/neighbor_graph.h"

namespace kinetome {

/// From one cell to the next: neither is negative, and not both are 0.
struct WarpingStep {
    int32_t rows = 0;
    int32_t columns = 0;
};

/// S3 §3 and the further ones of §5.
std::span<const WarpingStep> warping_steps();

struct GraphCell {
    int32_t row = 0;
    int32_t column = 0;
    bool operator==(const GraphCell&) const = default;
};

/// Cells joined by steps, in order.
struct WarpingPath {
    std::vector<GraphCell> cells;
    double cost = 0;  ///< sum of the cells' distances
};

/// Components of the graph's cells, joined by steps in either direction: a number for each of
/// graph.all_neighbours(), from 0 in the order of their first cells.
std::vector<int32_t> cell_components(const NeighborGraph& graph,
                                     std::span<const WarpingStep> steps = warping_steps());

/// The graph without the components that hold a cell (i, i).
NeighborGraph without_main_component(const NeighborGraph& graph,
                                     std::span<const WarpingStep> steps = warping_steps());

/// One path for each component of the graph's cells, in the order of cell_components: of those that
/// pass most rows and columns together the one of least cost (shortest path in a directed acyclic
/// graph; of equal ones that through the lowest cells).
std::vector<WarpingPath> component_paths(const NeighborGraph& graph,
                                         std::span<const WarpingStep> steps = warping_steps());

}  // namespace kinetome
