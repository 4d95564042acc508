#include "kinetome/models/motion_graph.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

/// A graph with these edges: each a clip of its own, of two pieces.
MotionGraph graph_of(int32_t nodes, const std::vector<std::pair<int32_t, int32_t>>& edges) {
    std::vector<MotionPiece> pieces;
    std::vector<int32_t> node_of;
    for (const auto& [from, to] : edges) {
        const auto clip = int32_t(pieces.size());
        pieces.push_back({clip, 0, 10});
        pieces.push_back({clip, 10, 25});
        node_of.insert(node_of.end(), {from, to});
    }
    return {pieces, node_of, nodes, 0};
}

std::vector<std::pair<int32_t, int32_t>> random_edges(int32_t nodes, uint64_t item) {
    RandomStream random(4, "random edges", item);
    std::vector<std::pair<int32_t, int32_t>> edges(random.below(3 * uint64_t(nodes)));
    for (auto& [from, to] : edges) {
        from = int32_t(random.below(uint64_t(nodes)));
        to = int32_t(random.below(uint64_t(nodes)));
    }
    return edges;
}

/// Edges on the shortest way from i to j; by repeated relaxation, as slow as it is plain.
std::vector<std::vector<int>> all_distances(int32_t nodes,
                                            const std::vector<std::pair<int32_t, int32_t>>& edges) {
    constexpr int none = 1000;
    std::vector<std::vector<int>> distance(size_t(nodes), std::vector<int>(size_t(nodes), none));
    for (size_t i = 0; i < size_t(nodes); ++i) distance[i][i] = 0;
    for (int32_t round = 0; round < nodes; ++round) {
        for (auto& row : distance) {
            for (const auto& [from, to] : edges) {
                row[size_t(to)] = std::min(row[size_t(to)], row[size_t(from)] + 1);
            }
        }
    }
    return distance;
}

std::vector<int32_t> to_vector(std::span<const int32_t> nodes) {
    return {nodes.begin(), nodes.end()};
}

}  // namespace

TEST_CASE("pieces that follow each other in a take make the edges of their nodes") {
    //     clip 0:  A B A      clip 1:  A B, B after 5 frames, C after 50
    const std::vector<MotionPiece> pieces = {{0, 20, 30}, {0, 0, 10},  {0, 10, 20}, {1, 0, 8},
                                             {1, 8, 20},  {1, 25, 40}, {1, 90, 100}};
    const std::vector<int32_t> node_of = {0, 0, 1, 0, 1, 1, 2};
    const MotionGraph graph(pieces, node_of, 3, 30);
    CHECK(to_vector(graph.members(0)) == std::vector<int32_t>{0, 1, 3});
    CHECK(to_vector(graph.targets(0)) == std::vector<int32_t>{1});
    CHECK(to_vector(graph.targets(1)) == std::vector<int32_t>{0, 1});
    CHECK(graph.targets(2).empty());

    const auto from_a = graph.successions(0, 0);
    REQUIRE(from_a.size() == 2);
    CHECK(from_a[0] == Succession{1, 2});
    CHECK(from_a[1] == Succession{3, 4});
    const auto from_b = graph.successions(1);
    REQUIRE(from_b.size() == 2);
    CHECK(from_b[0] == Succession{2, 0});
    CHECK(from_b[1] == Succession{4, 5});
    CHECK(graph.gap(from_b[1]) == 5);

    CHECK(to_vector(MotionGraph(pieces, node_of, 3, 60).targets(1)) ==
          std::vector<int32_t>{0, 1, 2});
}

TEST_CASE("what cannot be a motion graph is refused") {
    CHECK_THROWS_AS(MotionGraph({{0, 0, 10}, {0, 9, 20}}, {0, 0}, 1, 0), std::invalid_argument);
    CHECK_THROWS_AS(MotionGraph({{0, 10, 10}}, {0}, 1, 0), std::invalid_argument);
    CHECK_THROWS_AS(MotionGraph({{0, 0, 10}}, {1}, 1, 0), std::invalid_argument);
    CHECK_THROWS_AS(MotionGraph({{0, 0, 10}}, {}, 1, 0), std::invalid_argument);
    CHECK(MotionGraph({}, {}, 0, 0).nodes() == 0);
    CHECK(strong_components(MotionGraph({}, {}, 0, 0)).nodes.empty());
}

TEST_CASE("strong components, reach and shortest paths are those of a plain search") {
    for (uint64_t item = 0; item < 200; ++item) {
        const int32_t nodes = 1 + int32_t(item % 9);
        const auto edges = random_edges(nodes, item);
        const MotionGraph graph = graph_of(nodes, edges);
        const auto distance = all_distances(nodes, edges);
        const auto components = strong_components(graph);
        for (int32_t i = 0; i < nodes; ++i) {
            const auto reached = nodes_reached(graph, std::vector{i});
            const auto reaching = nodes_that_reach(graph, std::vector{i});
            for (int32_t j = 0; j < nodes; ++j) {
                const bool there = distance[size_t(i)][size_t(j)] < 1000;
                const bool back = distance[size_t(j)][size_t(i)] < 1000;
                CHECK(reached[size_t(j)] == there);
                CHECK(reaching[size_t(j)] == back);
                CHECK((components.component_of[size_t(i)] == components.component_of[size_t(j)]) ==
                      (there && back));
                const auto path = shortest_path(graph, std::vector{i}, std::vector{j});
                REQUIRE(path.empty() == !there);
                if (path.empty()) continue;
                CHECK(path.front() == i);
                CHECK(path.back() == j);
                CHECK(int(path.size()) == distance[size_t(i)][size_t(j)] + 1);
                for (size_t k = 0; k + 1 < path.size(); ++k) {
                    CHECK(std::ranges::binary_search(graph.targets(path[k]), path[k + 1]));
                }
            }
        }
    }
}

TEST_CASE(
    "components are numbered by their lowest node, and a lone node is a cycle if it follows "
    "itself") {
    const MotionGraph graph = graph_of(5, {{3, 1}, {1, 3}, {3, 4}, {4, 4}, {0, 2}});
    const auto components = strong_components(graph);
    CHECK(components.nodes == std::vector<std::vector<int32_t>>{{0}, {1, 3}, {2}, {4}});
    CHECK(components.cyclic == std::vector<bool>{false, true, false, true});
}

TEST_CASE("of equally short paths the one with the lowest nodes is taken, of ends the nearest") {
    const MotionGraph graph = graph_of(6, {{0, 2}, {0, 1}, {1, 5}, {2, 5}, {3, 5}, {5, 4}});
    CHECK(shortest_path(graph, std::vector{0}, std::vector{5}) == std::vector<int32_t>{0, 1, 5});
    CHECK(shortest_path(graph, std::vector{0, 3}, std::vector{4, 5}) == std::vector<int32_t>{3, 5});
    CHECK(shortest_path(graph, std::vector{4}, std::vector{0, 3}).empty());
    CHECK(shortest_path(graph, std::vector<int32_t>{}, std::vector{0}).empty());
}

TEST_CASE("a node leads where those linked with it do") {
    MotionGraph graph = graph_of(6, {{0, 1}, {2, 3}, {3, 2}, {4, 5}});
    CHECK(graph.next_nodes(1).empty());
    CHECK(shortest_path(graph, std::vector<int32_t>{0}, std::vector<int32_t>{3}).empty());
    graph.link(std::vector<NodeLink>{{2, 1}, {1, 2}, {1, 4}});
    CHECK(graph.links() == std::vector<NodeLink>{{1, 2}, {1, 4}});
    CHECK(to_vector(graph.linked(1)) == std::vector<int32_t>{2, 4});
    CHECK(graph.with_linked(std::vector<int32_t>{2, 3}) == std::vector<int32_t>{1, 2, 3});
    CHECK(graph.next_nodes(1) == std::vector<int32_t>{3, 5});
    CHECK(graph.ways_on(1).size() == 2);
    CHECK(to_vector(graph.targets(1)).empty());  // its own edges stay its own
    CHECK(shortest_path(graph, std::vector<int32_t>{0}, std::vector<int32_t>{3}) ==
          std::vector<int32_t>{0, 1, 3});
    CHECK(nodes_reached(graph, std::vector<int32_t>{0}) ==
          std::vector<bool>{true, true, true, true, false, true});
    CHECK(nodes_that_reach(graph, std::vector<int32_t>{5}) ==
          std::vector<bool>{true, true, false, false, true, true});
    const StrongComponents components = strong_components(graph);
    CHECK(components.component_of == std::vector<int32_t>{0, 1, 2, 2, 3, 4});
    CHECK(components.cyclic == std::vector<bool>{false, false, true, false, false});
    graph.link({});
    CHECK(graph.links().empty());
    CHECK_THROWS_AS(graph.link(std::vector<NodeLink>{{1, 6}}), std::invalid_argument);
    CHECK_THROWS_AS(graph.link(std::vector<NodeLink>{{-1, 1}}), std::invalid_argument);
    CHECK_THROWS_AS(graph.link(std::vector<NodeLink>{{1, 1}}), std::invalid_argument);
}
