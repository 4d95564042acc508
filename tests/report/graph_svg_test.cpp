#include "kinetome/report/graph_svg.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <regex>
#include <string_view>

#include "well_formed.h"

using namespace kinetome;
using Catch::Matchers::Contains;

namespace {

/// a → b → a → b in one clip and c → d in another, 60, 120, 24 and 36 frames long.
PrimitiveGraph toy_graph() {
    PrimitiveGraph graph = primitive_graph(
        {{0, 0, 60}, {0, 60, 180}, {0, 180, 240}, {0, 240, 360}, {1, 0, 24}, {1, 24, 60}},
        std::vector<int32_t>{0, 1, 0, 1, 2, 3},
        std::vector<std::string>{"walk", "", "walk", "", "", "<b>&\""}, 0);
    graph.style = {.piece = "member", .group = "bundle", .boxes_by_size = true};
    return graph;
}

struct Rectangle {
    double x, y, width, height;
};

/// Of the boxes, without the ground they are drawn on.
std::vector<Rectangle> boxes_of(const std::string& picture) {
    const std::regex box(
        "<rect x=\"([0-9.]+)\" y=\"([0-9.]+)\" width=\"([0-9.]+)\" height=\"([0-9.]+)\"");
    std::vector<Rectangle> boxes;
    for (std::sregex_iterator i(picture.begin(), picture.end(), box), end; i != end; ++i) {
        boxes.push_back(
            {std::stod((*i)[1]), std::stod((*i)[2]), std::stod((*i)[3]), std::stod((*i)[4])});
    }
    return boxes;
}

int64_t count(std::string_view text, std::string_view part) {
    int64_t found = 0;
    for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
    return found;
}

}  // namespace

TEST_CASE(
    "a box is as wide as the mean length of its pieces and as high as the root of their number") {
    const auto boxes = boxes_of(graph_svg("toy", toy_graph(), 120));
    REQUIRE(boxes.size() == 4);
    CHECK(boxes[0].width == Approx(boxes[1].width / 2));
    CHECK(boxes[2].width == Approx(boxes[3].width * 24 / 36).epsilon(1e-3));
    CHECK(boxes[0].height == boxes[1].height);
    CHECK(boxes[0].height == Approx(std::sqrt(2) * boxes[2].height).epsilon(1e-3));
}

TEST_CASE("every edge is an arrow, and no box covers another") {
    const PrimitiveGraph graph = toy_graph();
    const std::string picture = graph_svg("toy", graph, 120);
    CHECK(count(picture, "marker-end") == graph.graph.edges());
    CHECK_THAT(picture, Contains("bundle 1 to walk (bundle 0), once"));
    CHECK_THAT(picture, Contains("walk (bundle 0) to bundle 1, 2 times"));
    const auto boxes = boxes_of(picture);
    for (size_t a = 0; a < boxes.size(); ++a) {
        for (size_t b = 0; b < a; ++b) {
            const bool apart = boxes[a].x + boxes[a].width < boxes[b].x ||
                               boxes[b].x + boxes[b].width < boxes[a].x ||
                               boxes[a].y + boxes[a].height < boxes[b].y ||
                               boxes[b].y + boxes[b].height < boxes[a].y;
            CHECK(apart);
        }
    }
}

TEST_CASE("boxes that a walk comes back to are told from those it leaves for ever") {
    const std::string picture = graph_svg("toy", toy_graph(), 120);
    CHECK(count(picture, "#77aadd") == 2);
    CHECK(count(picture, "#d4d4d4") == 2);
}

TEST_CASE("names that look like markup stay names") {
    const std::string picture = graph_svg("</title><script>", toy_graph(), 120);
    CHECK(XmlReader(picture).is_well_formed());
    CHECK(count(picture, "<script>") == 0);
    CHECK_THAT(picture, Contains("&lt;b&gt;&amp;"));
}

TEST_CASE("a graph of many nodes without any arrow is drawn in lines") {
    std::vector<MotionPiece> pieces;
    std::vector<int32_t> clusters;
    for (int32_t clip = 0; clip < 60; ++clip) {
        pieces.push_back({clip, 0, 100});
        clusters.push_back(clip);
    }
    const auto graph = primitive_graph(pieces, clusters, {}, 0);
    const auto boxes = boxes_of(graph_svg("lonely", graph, 120));
    REQUIRE(boxes.size() == 60);
    CHECK(boxes.front().y < boxes.back().y);
    for (const Rectangle& box : boxes) CHECK(box.x + box.width < 1200);
}

TEST_CASE("boxes of primitives have room for their names, however short their motions") {
    PrimitiveGraph graph = toy_graph();
    graph.style = {};
    const std::string picture = graph_svg("toy", graph, 120);
    CHECK_THAT(picture, Contains(">walk (cluster 0)</text>"));
    CHECK_THAT(picture, Contains(">cluster 2</text>"));
}

TEST_CASE("links of nodes are dashed lines under the boxes, in a well-formed picture") {
    PrimitiveGraph graph = toy_graph();
    CHECK(count(graph_svg("toy", graph, 120), "stroke-dasharray") == 0);
    graph.graph.link(std::vector<NodeLink>{{0, 3}});
    const std::string picture = graph_svg("toy", graph, 120);
    CHECK(count(picture, "stroke-dasharray") == 1);
    CHECK_THAT(picture, Contains("<title>walk (bundle 0) as &lt;b&gt;&amp;"));
    CHECK(XmlReader(picture).is_well_formed());
}
