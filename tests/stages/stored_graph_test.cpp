#include "kinetome/stages/stored_graph.h"

#include <catch2/catch.hpp>

#include "kinetome/base/error.h"
#include "kinetome/store/json_text.h"

using namespace kinetome;

namespace {

/// Clips whose names begin with "slow" have half the rate.
const ClipSource source = {[](const std::string& clip) {
                               return ClipKind{"class", clip.starts_with("slow") ? 60.0 : 120.0};
                           },
                           nullptr};

StoredGraph example() {
    return stored_graph({{"one", 0, 100, 4, "walk"},
                         {"one", 100, 190, 4, ""},
                         {"one", 200, 300, -1, ""},
                         {"slow", 0, 50, 4, "walk"},
                         {"slow", 50, 90, 2, "=\"jump\""}},
                        source, 1);
}

}  // namespace

TEST_CASE("primitives of all rates make one graph, and keep their own frames") {
    const StoredGraph graph = example();
    CHECK(graph.rate == 120);
    CHECK(graph.nodes.graph.pieces()[4] == MotionPiece{1, 100, 180});
    CHECK(graph.primitives[4].end == 90);
    CHECK(graph.nodes.graph.nodes() == 3);
    CHECK_THROWS_AS(stored_graph({}, source, 1), UsageError);
}

TEST_CASE("the adjacency as CSV has a line a succession, guarded against formulas") {
    CHECK(write_graph(example(), GraphFormat::csv) ==
          "from_node,to_node,from_cluster,to_cluster,from_label,to_label,clip,from_first,from_end,"
          "to_first,to_end\n"
          "1,0,4,2,walk,\"'=\"\"jump\"\"\",slow,0,50,50,90\n"
          "1,1,4,4,walk,walk,one,0,100,100,190\n"
          "1,2,4,-1,walk,,one,100,190,200,300\n");
}

TEST_CASE("the adjacency as JSON has nodes with primitives, edges with successions") {
    const Json graph = Json::parse(write_graph(example(), GraphFormat::json));
    REQUIRE(graph["nodes"].size() == 3);
    CHECK(graph["nodes"][1]["cluster"] == 4);
    CHECK(graph["nodes"][1]["label"] == "walk");
    CHECK(graph["nodes"][1]["primitives"].size() == 3);
    CHECK(graph["nodes"][1]["primitives"][2]["clip"] == "slow");
    CHECK(graph["nodes"][1]["primitives"][2]["end"] == 50);
    CHECK(graph["nodes"][0]["component"] != graph["nodes"][1]["component"]);
    REQUIRE(graph["edges"].size() == 3);
    CHECK(graph["edges"][1] == Json{{"from", 1}, {"to", 1}, {"successions", 1}});
}

TEST_CASE("the adjacency as DOT quotes what labels hold") {
    const std::string text = write_graph(example(), GraphFormat::dot);
    CHECK(text ==
          "digraph primitives {\n  node [shape=box];\n"
          "  n0 [label=\"=\\\"jump\\\" (cluster 2): 1 primitive\"];\n"
          "  n1 [label=\"walk (cluster 4): 3 primitives\"];\n"
          "  n2 [label=\"a primitive of no cluster: 1 primitive\"];\n"
          "  n1 -> n0 [label=1];\n  n1 -> n1 [label=1];\n  n1 -> n2 [label=1];\n}\n");
    CHECK(parse_graph_format("dot") == GraphFormat::dot);
    CHECK(parse_graph_format("svg") == GraphFormat::svg);
    CHECK_THROWS_AS(parse_graph_format("png"), UsageError);
}

TEST_CASE("links of clusters join the nodes that a graph has of them, and are told apart") {
    StoredGraph graph = example();
    link_clusters(graph, {{4, 2}, {4, 7}});
    CHECK(graph.nodes.graph.links() == std::vector<NodeLink>{{0, 1}});
    const Json whole = Json::parse(write_graph(graph, GraphFormat::json));
    CHECK(whole["links"] == Json::array({Json{{"first", 0}, {"second", 1}}}));
    CHECK(whole["edges"].size() == 3);
    CHECK(write_graph(graph, GraphFormat::dot)
              .ends_with("  n0 -> n1 [dir=none, style=dashed, constraint=false];\n}\n"));
    CHECK(write_graph(graph, GraphFormat::csv) == write_graph(example(), GraphFormat::csv));
}

TEST_CASE("a primitive has the label that covers most of it, if that is half") {
    std::vector<ClipPrimitive> primitives = {
        {"one", 0, 100, 0}, {"one", 100, 200, 0}, {"one", 200, 300, 0, "kept"}, {"two", 0, 100, 0}};
    label_primitives(primitives, {{"one", 0, 50, "walk"},
                                  {"one", 100, 130, "walk"},
                                  {"one", 130, 170, "run"},
                                  {"one", 170, 200, "walk"},
                                  {"one", 200, 249, "walk"},
                                  {"three", 0, 100, "walk"}});
    CHECK(primitives[0].label == "walk");
    CHECK(primitives[1].label == "walk");  // 60 of its frames, in two rows
    CHECK(primitives[2].label == "kept");
    CHECK(primitives[3].label.empty());
}
