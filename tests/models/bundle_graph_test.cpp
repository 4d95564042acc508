#include "kinetome/models/bundle_graph.h"

#include <catch2/catch.hpp>
#include <vector>

#include "kinetome/base/random.h"

using namespace kinetome;

TEST_CASE("transitions between bundles become edges, those at the ends of clips dangle") {
    // Clip 0: 5 frames dangle, A [5, 20), B [20, 40) at once, transition of 10, A [50, 60), B
    // [60, 70), transition of 20, A [90, 95), 5 dangle. Clip 1 has no bundle.
    const std::vector<BundleMember> members = {
        {2, {0, 0, 5}},   {0, {0, 5, 20}},  {1, {0, 20, 40}}, {3, {0, 40, 50}},  {0, {0, 50, 60}},
        {1, {0, 60, 70}}, {4, {0, 70, 90}}, {0, {0, 90, 95}}, {5, {0, 95, 100}}, {6, {1, 0, 30}}};
    const std::vector<int32_t> node_of = {0, 1, -1, -1, -1, -1, -1};
    const BundleGraph bundles = bundle_graph(members, node_of, 2, std::vector<int64_t>{100, 30});
    const MotionGraph& graph = bundles.graph;
    REQUIRE(graph.nodes() == 2);
    CHECK(graph.members(0).size() == 3);
    CHECK(graph.members(1).size() == 2);
    REQUIRE(graph.edges() == 2);  // A to B, B to A: each merged out of two
    CHECK(graph.targets(0)[0] == 1);
    CHECK(graph.successions(0, 0).size() == 2);
    REQUIRE(graph.successions(1, 0).size() == 2);
    CHECK(graph.gap(graph.successions(1, 0)[0]) == 10);  // the alternatives are kept
    CHECK(graph.gap(graph.successions(1, 0)[1]) == 20);
    CHECK(bundles.frames.in_nodes == 15 + 20 + 10 + 10 + 5);
    CHECK(bundles.frames.in_edges == 30);
    CHECK(bundles.frames.dangling == 10 + 30);
    CHECK(strong_components(graph).nodes.size() == 1);
}

TEST_CASE("nodes, edges and dangling ends hold every frame once, whatever the bundles are") {
    for (uint64_t number = 0; number < 100; ++number) {
        RandomStream random(number, "bundle graph test");
        std::vector<int32_t> letters;
        std::vector<int64_t> clips;
        int64_t frames = 0;
        for (uint64_t clip = random.below(4) + 1; clip > 0; --clip) {
            clips.push_back(static_cast<int64_t>(random.below(80)));
            for (int64_t frame = 0; frame < clips.back(); ++frame)
                letters.push_back(static_cast<int32_t>(random.below(3)));
            frames += clips.back();
        }
        const MotionString string = make_motion_string(letters, clips);
        const auto bundles = find_motion_bundles(string, AccessibilityMatrix(3), 5, {});
        std::vector<int32_t> node_of, f;
        int32_t nodes = 0;
        for (const SubstringBundle& bundle : bundles)
            node_of.push_back(bundle.is_degenerate() ? -1 : nodes++);
        for (int64_t j = 0; j < string.size(); ++j)
            f.push_back(static_cast<int32_t>(string.mean_frame(j)));
        const auto members = bundle_members(string, bundles, f);
        const BundleGraph graph = bundle_graph(members, node_of, nodes, clips);
        CHECK(graph.frames.sum() == frames);
        for (size_t i = 0; i + 1 < members.size(); ++i) {  // no gap, no overlap inside a clip
            if (members[i].frames.clip == members[i + 1].frames.clip)
                CHECK(members[i].frames.end == members[i + 1].frames.first);
        }
    }
}

TEST_CASE("bundles linked to one node are left by any of their members") {
    const std::vector<BundleMember> members = {
        {0, {0, 0, 10}}, {1, {0, 10, 20}}, {2, {1, 0, 10}}, {3, {1, 10, 20}}};
    const BundleGraph apart =
        bundle_graph(members, std::vector<int32_t>{0, 1, 2, 3}, 4, std::vector<int64_t>{20, 20});
    const std::vector<int32_t> from = {0}, other_body = {3};
    CHECK(shortest_path(apart.graph, from, other_body).empty());
    const BundleGraph linked =
        bundle_graph(members, std::vector<int32_t>{0, 1, 0, 2}, 3, std::vector<int64_t>{20, 20});
    const std::vector<int32_t> there = {2};
    CHECK(shortest_path(linked.graph, from, there) == std::vector<int32_t>{0, 2});
}

TEST_CASE("members of bundles or clips that are not there are refused") {
    const std::vector<int32_t> node_of = {0};
    const std::vector<int64_t> clips = {10};
    const auto make = [&](const BundleMember& member) {
        return bundle_graph(std::vector<BundleMember>{member}, node_of, 1, clips);
    };
    CHECK_NOTHROW(make({0, {0, 0, 10}}));
    CHECK_THROWS_AS(make({1, {0, 0, 10}}), std::invalid_argument);
    CHECK_THROWS_AS(make({0, {1, 0, 10}}), std::invalid_argument);
    CHECK_THROWS_AS(make({0, {0, 0, 11}}), std::invalid_argument);
}
