#include "minor_diagonals.h"

#include <algorithm>

#include "frame_count.h"
#include "kinetome/models/graph_paths.h"

namespace kinetome {
namespace {

struct PathRule {
    int64_t shortest = 0;  ///< frames
    double steepest = 0;
    double least_symmetry = 0;
};

double symmetry(const WarpingPath& path, const NeighborGraph& graph) {
    const auto mirrored = std::ranges::count_if(
        path.cells, [&](const GraphCell& cell) { return graph.has_edge(cell.column, cell.row); });
    return double(mirrored) / double(path.cells.size());
}

/// Whether a path matches one stretch of frames with another, rather than a few frames by chance.
bool matches_stretches(const WarpingPath& path, const NeighborGraph& graph, const PathRule& rule) {
    const GraphCell& first = path.cells.front();
    const GraphCell& last = path.cells.back();
    const int64_t rows = last.row - first.row + 1, columns = last.column - first.column + 1;
    return std::min(rows, columns) >= rule.shortest &&
           double(std::max(rows, columns)) <= rule.steepest * double(std::min(rows, columns)) &&
           symmetry(path, graph) >= rule.least_symmetry;
}

}  // namespace

std::vector<int64_t> minor_diagonal_cuts(const NeighborGraph& graph, const RowRange& activity,
                                         const PrimitiveOptions& options) {
    const WarpingPathOptions& paths = options.warping_paths;
    const PathRule rule{frame_count(options.shortest, options.rate), paths.steepest,
                        paths.least_symmetry};
    const NeighborGraph inside = subgraph(graph, activity);
    std::vector<int64_t> columns;
    for (const WarpingPath& path : component_paths(without_main_component(inside))) {
        const bool is_upper = path.cells.front().column > path.cells.front().row;
        if (is_upper && matches_stretches(path, inside, rule)) {
            columns.push_back(activity.first + path.cells.front().column);
        }
    }
    std::ranges::sort(columns);
    std::vector<int64_t> cuts{activity.first};
    for (const int64_t column : columns) {
        const bool leaves_room = activity.end - column >= rule.shortest;
        if (leaves_room && column - cuts.back() >= rule.shortest) cuts.push_back(column);
    }
    cuts.push_back(activity.end);
    return cuts;
}

}  // namespace kinetome
