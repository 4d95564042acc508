#include "kinetome/models/graph_paths.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace kinetome {
namespace {

constexpr std::array<WarpingStep, 7> all_steps{
    {{1, 1}, {0, 1}, {1, 0}, {2, 1}, {1, 2}, {2, 2}, {5, 5}}};

/// The number of a cell among all of the graph's; -1: there is none.
int64_t cell_number(const NeighborGraph& graph, int64_t row, int64_t column) {
    if (row < 0) return -1;
    const auto columns = graph.neighbours(row);
    const auto found = std::ranges::lower_bound(columns, column);
    if (found == columns.end() || *found != column) return -1;
    return graph.offsets()[static_cast<size_t>(row)] + (found - columns.begin());
}

/// Calls visit(to, from, step) for each cell, in order, and each earlier one that a step leads
/// from.
template <class Visit>
void for_each_step(const NeighborGraph& graph, std::span<const WarpingStep> steps,
                   const Visit& visit) {
    int64_t cell = 0;
    for (int64_t row = 0; row < graph.frames(); ++row) {
        for (const int32_t column : graph.neighbours(row)) {
            for (const WarpingStep& step : steps) {
                const int64_t from = cell_number(graph, row - step.rows, column - step.columns);
                if (from >= 0) visit(cell, from, step);
            }
            ++cell;
        }
    }
}

/// Sets that grow together; each is named by its lowest member.
class DisjointSets {
  public:
    explicit DisjointSets(size_t members) : parent_(members) {
        std::iota(parent_.begin(), parent_.end(), int64_t{0});
    }
    int64_t find(int64_t member) {
        while (at(member) != member) member = at(member) = at(at(member));
        return member;
    }
    void join(int64_t a, int64_t b) {
        a = find(a);
        b = find(b);
        at(std::max(a, b)) = std::min(a, b);
    }

  private:
    int64_t& at(int64_t member) { return parent_[static_cast<size_t>(member)]; }
    std::vector<int64_t> parent_;
};

/// The best path to a cell: that which passes most of the matrix, at least cost.
struct Arrival {
    int64_t extent = 0;  ///< rows and columns passed
    double cost = 0;
    int64_t previous = -1;

    bool better_than(const Arrival& other) const {
        return extent != other.extent ? extent > other.extent : cost < other.cost;
    }
};

std::vector<Arrival> best_arrivals(const NeighborGraph& graph, std::span<const WarpingStep> steps) {
    const std::vector<float>& distances = graph.all_distances();
    std::vector<Arrival> arrivals;
    for (const float distance : distances) arrivals.push_back({0, double(distance), -1});
    for_each_step(graph, steps, [&](int64_t to, int64_t from, const WarpingStep& step) {
        const Arrival& before = arrivals[static_cast<size_t>(from)];
        const Arrival arrival{before.extent + step.rows + step.columns,
                              before.cost + double(distances[static_cast<size_t>(to)]), from};
        Arrival& best = arrivals[static_cast<size_t>(to)];
        if (arrival.better_than(best)) best = arrival;
    });
    return arrivals;
}

std::vector<GraphCell> all_cells(const NeighborGraph& graph) {
    std::vector<GraphCell> cells;
    for (int64_t row = 0; row < graph.frames(); ++row) {
        for (const int32_t column : graph.neighbours(row)) {
            cells.push_back({static_cast<int32_t>(row), column});
        }
    }
    return cells;
}

}  // namespace

std::span<const WarpingStep> warping_steps() {
    return all_steps;
}

std::vector<int32_t> cell_components(const NeighborGraph& graph,
                                     std::span<const WarpingStep> steps) {
    DisjointSets sets(graph.all_neighbours().size());
    for_each_step(graph, steps,
                  [&](int64_t to, int64_t from, const WarpingStep&) { sets.join(to, from); });
    std::vector<int32_t> components;
    int32_t count = 0;
    for (size_t cell = 0; cell < graph.all_neighbours().size(); ++cell) {
        const auto lowest = static_cast<size_t>(sets.find(static_cast<int64_t>(cell)));
        components.push_back(lowest == cell ? count++ : components[lowest]);
    }
    return components;
}

NeighborGraph without_main_component(const NeighborGraph& graph,
                                     std::span<const WarpingStep> steps) {
    const std::vector<int32_t> components = cell_components(graph, steps);
    const std::vector<GraphCell> cells = all_cells(graph);
    std::vector<bool> is_main(cells.size(), false);
    for (size_t cell = 0; cell < cells.size(); ++cell) {
        if (cells[cell].row == cells[cell].column) is_main[size_t(components[cell])] = true;
    }
    std::vector<int64_t> offsets{0};
    std::vector<int32_t> neighbours;
    std::vector<float> distances;
    for (int64_t row = 0; row < graph.frames(); ++row) {
        for (auto cell = static_cast<size_t>(graph.offsets()[size_t(row)]);
             cell < static_cast<size_t>(graph.offsets()[size_t(row) + 1]); ++cell) {
            if (is_main[size_t(components[cell])]) continue;
            neighbours.push_back(cells[cell].column);
            distances.push_back(graph.all_distances()[cell]);
        }
        offsets.push_back(static_cast<int64_t>(neighbours.size()));
    }
    return {std::move(offsets), std::move(neighbours), std::move(distances)};
}

std::vector<WarpingPath> component_paths(const NeighborGraph& graph,
                                         std::span<const WarpingStep> steps) {
    const std::vector<Arrival> arrivals = best_arrivals(graph, steps);
    std::vector<size_t> ends;  // where the best path of each component ends
    const std::vector<int32_t> components = cell_components(graph, steps);
    for (size_t cell = 0; cell < components.size(); ++cell) {
        const auto component = static_cast<size_t>(components[cell]);
        if (component == ends.size()) ends.push_back(cell);
        if (arrivals[cell].better_than(arrivals[ends[component]])) ends[component] = cell;
    }
    const std::vector<GraphCell> cells = all_cells(graph);
    std::vector<WarpingPath> paths;
    for (const size_t end : ends) {
        WarpingPath& path = paths.emplace_back();
        path.cost = arrivals[end].cost;
        for (auto cell = static_cast<int64_t>(end); cell >= 0;) {
            path.cells.push_back(cells[static_cast<size_t>(cell)]);
            cell = arrivals[static_cast<size_t>(cell)].previous;
        }
        std::ranges::reverse(path.cells);
    }
    return paths;
}

}  // namespace kinetome
