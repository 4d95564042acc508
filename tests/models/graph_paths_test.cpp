#include "kinetome/models/graph_paths.h"

#include <array>
#include <catch2/catch.hpp>
#include <set>

#include "toy_motion.h"

using namespace kinetome;

namespace {

struct WeightedCell {
    int64_t row;
    int32_t column;
    float distance;
};

/// A graph of these cells, given in order.
NeighborGraph graph_with(int64_t frames, const std::vector<WeightedCell>& cells) {
    std::vector<int64_t> offsets{0};
    std::vector<int32_t> columns;
    std::vector<float> distances;
    for (int64_t row = 0; row < frames; ++row) {
        for (const WeightedCell& cell : cells) {
            if (cell.row != row) continue;
            columns.push_back(cell.column);
            distances.push_back(cell.distance);
        }
        offsets.push_back(static_cast<int64_t>(columns.size()));
    }
    return {offsets, columns, distances};
}

constexpr std::array<WarpingStep, 3> plain_steps{{{1, 1}, {0, 1}, {1, 0}}};

}  // namespace

TEST_CASE("cells that a step joins belong together, whichever comes first") {
    // (0, 4) and (1, 3) both lead to (1, 4): joined through what they lead to.
    const NeighborGraph graph = graph_with(
        6, {{0, 1, 1}, {0, 4, 1}, {1, 2, 1}, {1, 3, 1}, {1, 4, 1}, {4, 0, 1}, {5, 2, 1}});
    CHECK(cell_components(graph, plain_steps) == std::vector<int32_t>{0, 0, 0, 0, 0, 1, 2});
    CHECK(cell_components(graph) == std::vector<int32_t>{0, 0, 0, 0, 0, 1, 1});  // (1, 2)
    CHECK(cell_components(graph, std::array<WarpingStep, 1>{{{5, 5}}}) ==
          std::vector<int32_t>{0, 1, 2, 3, 4, 5, 6});
    CHECK(cell_components({}).empty());
}

TEST_CASE("the main component is what hangs together with a frame and itself, no more") {
    const MatrixF rows = toy::Motion().circle(4, 30, 0).rows();
    const NeighborGraph graph = toy::graph_of(rows);
    const NeighborGraph rest = without_main_component(graph);
    const std::vector<int32_t> components = cell_components(graph);
    std::set<int32_t> main;
    size_t kept = 0, cell = 0;
    for (int64_t i = 0; i < graph.frames(); ++i) {
        for (const int32_t j : graph.neighbours(i)) {
            if (i == j) main.insert(components[cell]);
            ++cell;
        }
    }
    REQUIRE(main.size() == 1);
    cell = 0;
    for (int64_t i = 0; i < graph.frames(); ++i) {
        for (const int32_t j : graph.neighbours(i)) {
            const bool is_main = main.contains(components[cell++]);
            CHECK(rest.has_edge(i, j) == !is_main);
            // The main diagonal is as thick as the radius lets it be, the next a period away.
            CHECK(is_main == (std::abs(i - j) < 15));
            kept += !is_main;
        }
    }
    CHECK(rest.all_distances().size() == kept);
    CHECK(kept > 0);
}

TEST_CASE("a component's path is its longest, and the cheapest of these") {
    // A diagonal, with a costly and a cheap way round its gap, and a dead end.
    const NeighborGraph graph = graph_with(5, {{0, 0, 1},
                                               {1, 1, 1},
                                               {1, 2, 5},
                                               {2, 1, 2},
                                               {2, 2, 9},
                                               {3, 2, 2},
                                               {3, 3, 1},
                                               {3, 4, 1},
                                               {4, 3, 1},
                                               {4, 4, 1}});
    const std::vector<WarpingPath> paths = component_paths(graph, plain_steps);
    REQUIRE(paths.size() == 1);
    CHECK(paths[0].cells == std::vector<GraphCell>{{0, 0}, {1, 1}, {2, 1}, {3, 2}, {3, 3}, {4, 4}});
    CHECK(paths[0].cost == Approx(8));
}

TEST_CASE("no path through a component is longer, or as long and cheaper") {
    RandomStream random(2, "paths");
    for (int trial = 0; trial < 20; ++trial) {
        std::vector<WeightedCell> cells;
        for (int64_t i = 0; i < 6; ++i) {
            for (int32_t j = 0; j < 6; ++j) {
                if (random.uniform() < 0.55) cells.push_back({i, j, float(1 + random.below(9))});
            }
        }
        const NeighborGraph graph = graph_with(6, cells);
        const std::vector<int32_t> components = cell_components(graph);
        const std::vector<WarpingPath> paths = component_paths(graph);
        std::vector<std::pair<int64_t, double>> best(paths.size(), {0, -1e9});
        // Every path, by walking on from every cell.
        const auto walk = [&](const auto& self, size_t component, size_t first, size_t at,
                              double cost) -> void {
            const int64_t extent =
                cells[at].row - cells[first].row + cells[at].column - cells[first].column;
            best[component] = std::max(best[component], {extent, -cost});
            for (size_t to = 0; to < cells.size(); ++to) {
                for (const WarpingStep& step : warping_steps()) {
                    if (cells[at].row + step.rows != cells[to].row) continue;
                    if (cells[at].column + step.columns != cells[to].column) continue;
                    self(self, component, first, to, cost + double(cells[to].distance));
                }
            }
        };
        for (size_t cell = 0; cell < cells.size(); ++cell) {
            walk(walk, size_t(components[cell]), cell, cell, double(cells[cell].distance));
        }
        for (size_t p = 0; p < paths.size(); ++p) {
            const GraphCell first = paths[p].cells.front(), last = paths[p].cells.back();
            CHECK(last.row - first.row + last.column - first.column == best[p].first);
            CHECK(paths[p].cost == Approx(-best[p].second));
        }
    }
}
