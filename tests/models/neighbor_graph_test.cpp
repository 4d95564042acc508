#include "kinetome/models/neighbor_graph.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

MatrixF wandering(int64_t frames, int64_t columns) {
    RandomStream random(3, "wandering");
    MatrixF rows = MatrixF::Zero(frames, columns);
    for (int64_t i = 1; i < frames; ++i) {
        for (int64_t j = 0; j < columns; ++j) {
            rows(i, j) = rows(i - 1, j) + float(random.uniform() - 0.5);
        }
    }
    return rows;
}

double distance(const MatrixF& rows, int64_t i, int64_t j) {
    return double((rows.row(i) - rows.row(j)).norm());
}

}  // namespace

TEST_CASE("a frame's neighbours are the frames within the radius, in order, itself among them") {
    const MatrixF rows = wandering(200, 3);
    const NeighborGraph graph = neighbor_graph(rows, {1.0, 200}, KnnEngine::blocks, 1);
    REQUIRE(graph.frames() == 200);
    for (int64_t i = 0; i < 200; ++i) {
        CHECK(graph.has_edge(i, i));
        for (int64_t j = 0; j < 200; ++j) {
            if (std::abs(distance(rows, i, j) - 1.0) < 1e-5) continue;
            CHECK(graph.has_edge(i, j) == (distance(rows, i, j) < 1.0));
        }
    }
}

TEST_CASE("the part within a radius is the graph of that radius, lists cut at k all the same") {
    const MatrixF rows = wandering(300, 3);
    const auto wide = neighbor_graph(rows, {1.5, 12}, KnnEngine::blocks, 1);
    const auto narrow = neighbor_graph(rows, {0.8, 12}, KnnEngine::blocks, 1);
    const auto part = within(wide, 0.8);
    CHECK(part.offsets() == narrow.offsets());
    CHECK(part.all_neighbours() == narrow.all_neighbours());
    CHECK(part.all_distances() == narrow.all_distances());
    CHECK(wide.all_neighbours().size() > narrow.all_neighbours().size());
}

TEST_CASE("symmetrised, an edge one way is an edge both ways, and no other comes in") {
    const MatrixF rows = wandering(300, 2);
    const auto graph = neighbor_graph(rows, {5, 6}, KnnEngine::blocks, 1);
    const auto both = symmetrised(graph);
    int64_t one_way = 0;
    for (int64_t i = 0; i < 300; ++i) {
        for (int64_t j = 0; j < 300; ++j) {
            one_way += graph.has_edge(i, j) && !graph.has_edge(j, i);
            CHECK(both.has_edge(i, j) == (graph.has_edge(i, j) || graph.has_edge(j, i)));
        }
    }
    CHECK(one_way > 0);
}

TEST_CASE("a subgraph holds the edges among its frames") {
    const auto graph = neighbor_graph(wandering(100, 2), {1, 100}, KnnEngine::blocks, 1);
    const auto part = subgraph(graph, {30, 70});
    REQUIRE(part.frames() == 40);
    for (int64_t i = 0; i < 40; ++i) {
        for (int64_t j = 0; j < 40; ++j) {
            CHECK(part.has_edge(i, j) == graph.has_edge(30 + i, 30 + j));
        }
    }
    CHECK_THROWS_AS(subgraph(graph, {30, 101}), std::invalid_argument);
}

TEST_CASE("a graph that was put together wrongly is refused") {
    CHECK_THROWS_AS(NeighborGraph({0, 1}, {1}, {0}), std::invalid_argument);
    CHECK_THROWS_AS(NeighborGraph({0, 2, 2}, {1, 0}, {0, 0}), std::invalid_argument);
    CHECK_THROWS_AS(NeighborGraph({0, 1}, {0, 0}, {0, 0}), std::invalid_argument);
    CHECK_NOTHROW(NeighborGraph({0, 2, 2}, {0, 1}, {0, 0}));
}
