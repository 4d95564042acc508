#include "kinetome/models/primitive_graph.h"

#include <catch2/catch.hpp>

using namespace kinetome;

TEST_CASE("primitives of a cluster share a node, those without one have nodes of their own") {
    const std::vector<MotionPiece> primitives = {{0, 0, 10}, {0, 10, 20}, {0, 20, 30},
                                                 {1, 0, 10}, {1, 12, 20}, {1, 20, 30}};
    const std::vector<int32_t> clusters = {7, 7, 2, -1, 7, -1};
    const std::vector<std::string> labels = {"run", "", "2", "", "jump", ""};
    const auto made = primitive_graph(primitives, clusters, labels, 5);
    CHECK(made.cluster_of == std::vector<int32_t>{2, 7, -1, -1});
    CHECK(made.label_of == std::vector<std::string>{"2", "jump", "", ""});
    CHECK(made.graph.node_of(0) == 1);
    CHECK(made.graph.node_of(2) == 0);
    CHECK(made.graph.node_of(3) == 2);
    CHECK(made.graph.node_of(5) == 3);
    CHECK(made.graph.targets(1).size() == 3);  // itself, cluster 2, the last primitive
    CHECK(made.name_of(1) == "jump (cluster 7)");
    CHECK(made.name_of(2) == "a primitive of no cluster");
}

TEST_CASE("nodes are found by label before they are found by number") {
    const std::vector<MotionPiece> primitives = {{0, 0, 10}, {0, 10, 20}, {0, 20, 30}, {0, 30, 40}};
    const auto made = primitive_graph(primitives, std::vector<int32_t>{0, 1, 2, 3},
                                      std::vector<std::string>{"run", "1", "run", ""}, 0);
    CHECK(made.nodes_named("run") == std::vector<int32_t>{0, 2});
    CHECK(made.nodes_named("1") == std::vector<int32_t>{1});
    CHECK(made.nodes_named("3") == std::vector<int32_t>{3});
    for (const char* const unknown : {"", "4", "-1", "3x", "walk"}) {
        CHECK(made.nodes_named(unknown).empty());
    }
    const auto bare = primitive_graph(primitives, std::vector<int32_t>{0, 0, 0, 0}, {}, 0);
    CHECK(bare.name_of(0) == "cluster 0");
    CHECK_THROWS_AS(primitive_graph(primitives, std::vector<int32_t>{0}, {}, 0),
                    std::invalid_argument);
}
