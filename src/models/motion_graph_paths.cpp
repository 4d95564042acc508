#include <algorithm>
#include <limits>
#include <numeric>

#include "kinetome/models/motion_graph.h"

namespace kinetome {
namespace {

using Edges = std::vector<std::vector<int32_t>>;

Edges forward_edges(const MotionGraph& graph) {
    Edges edges(static_cast<size_t>(graph.nodes()));
    for (int32_t node = 0; node < graph.nodes(); ++node)
        edges[static_cast<size_t>(node)] = graph.next_nodes(node);
    return edges;
}

Edges backward_edges(const MotionGraph& graph) {
    Edges edges(static_cast<size_t>(graph.nodes()));
    for (int32_t node = 0; node < graph.nodes(); ++node) {
        for (const int32_t target : graph.next_nodes(node)) {
            edges[static_cast<size_t>(target)].push_back(node);
        }
    }
    return edges;
}

constexpr int32_t out_of_reach = std::numeric_limits<int32_t>::max();

/// Edges on the shortest way to each node from one of `starts`.
std::vector<int32_t> distances(const Edges& edges, std::span<const int32_t> starts) {
    std::vector<int32_t> distance(edges.size(), out_of_reach);
    std::vector<int32_t> queue(starts.begin(), starts.end());
    for (const int32_t start : starts) distance[static_cast<size_t>(start)] = 0;
    for (size_t i = 0; i < queue.size(); ++i) {
        const auto node = static_cast<size_t>(queue[i]);
        for (const int32_t target : edges[node]) {
            if (distance[static_cast<size_t>(target)] != out_of_reach) continue;
            distance[static_cast<size_t>(target)] = distance[node] + 1;
            queue.push_back(target);
        }
    }
    return distance;
}

std::vector<bool> within_reach(const Edges& edges, std::span<const int32_t> starts) {
    std::vector<bool> reached;
    for (const int32_t distance : distances(edges, starts)) {
        reached.push_back(distance != out_of_reach);
    }
    return reached;
}

/// Nodes in the order in which a depth-first search leaves them.
std::vector<int32_t> leaving_order(const Edges& edges) {
    struct Visit {
        int32_t node;
        size_t next_edge = 0;
    };
    std::vector<int32_t> order;
    std::vector<bool> seen(edges.size());
    std::vector<Visit> open;
    const auto enter = [&](int32_t node) {
        if (seen[static_cast<size_t>(node)]) return;
        seen[static_cast<size_t>(node)] = true;
        open.push_back({node});
    };
    for (int32_t start = 0; start < static_cast<int32_t>(edges.size()); ++start) {
        enter(start);
        while (!open.empty()) {
            Visit& visit = open.back();
            const auto& targets = edges[static_cast<size_t>(visit.node)];
            if (visit.next_edge < targets.size()) {
                enter(targets[visit.next_edge++]);
            } else {
                order.push_back(visit.node);
                open.pop_back();
            }
        }
    }
    return order;
}

}  // namespace

/// Kosaraju & Sharir: what a search along the edges leaves last, a search against them finds first.
StrongComponents strong_components(const MotionGraph& graph) {
    const Edges backward = backward_edges(graph);
    const auto order = leaving_order(forward_edges(graph));
    std::vector<int32_t> lowest(backward.size(), -1);  // of each node's component
    for (auto start = order.rbegin(); start != order.rend(); ++start) {
        if (lowest[static_cast<size_t>(*start)] >= 0) continue;
        std::vector<int32_t> found = {*start};
        lowest[static_cast<size_t>(*start)] = *start;
        for (size_t i = 0; i < found.size(); ++i) {
            for (const int32_t source : backward[static_cast<size_t>(found[i])]) {
                if (lowest[static_cast<size_t>(source)] >= 0) continue;
                lowest[static_cast<size_t>(source)] = *start;
                found.push_back(source);
            }
        }
        const int32_t name = *std::ranges::min_element(found);
        for (const int32_t node : found) lowest[static_cast<size_t>(node)] = name;
    }

    StrongComponents components;
    components.component_of.resize(lowest.size());
    for (int32_t node = 0; node < graph.nodes(); ++node) {
        const int32_t name = lowest[static_cast<size_t>(node)];
        int32_t& component = components.component_of[static_cast<size_t>(node)];
        if (name == node) {
            component = static_cast<int32_t>(components.nodes.size());
            components.nodes.emplace_back();
            components.cyclic.push_back(std::ranges::binary_search(graph.next_nodes(node), node));
        } else {
            component = components.component_of[static_cast<size_t>(name)];
            components.cyclic[static_cast<size_t>(component)] = true;
        }
        components.nodes[static_cast<size_t>(component)].push_back(node);
    }
    return components;
}

std::vector<bool> nodes_that_reach(const MotionGraph& graph, std::span<const int32_t> targets) {
    return within_reach(backward_edges(graph), targets);
}

std::vector<bool> nodes_reached(const MotionGraph& graph, std::span<const int32_t> sources) {
    return within_reach(forward_edges(graph), sources);
}

std::vector<int32_t> shortest_path(const MotionGraph& graph, std::span<const int32_t> sources,
                                   std::span<const int32_t> targets) {
    const auto left = distances(backward_edges(graph), targets);
    const auto remaining = [&](int32_t node) { return left[static_cast<size_t>(node)]; };
    const auto nearest = [&](std::span<const int32_t> nodes) {
        return std::ranges::min(nodes, {},
                                [&](int32_t node) { return std::pair(remaining(node), node); });
    };
    if (sources.empty() || remaining(nearest(sources)) == out_of_reach) return {};
    std::vector<int32_t> path = {nearest(sources)};
    while (remaining(path.back()) > 0) path.push_back(nearest(graph.next_nodes(path.back())));
    return path;
}

}  // namespace kinetome
