#include "kinetome/stages/segment_table.h"

#include <catch2/catch.hpp>

#include "kinetome/base/error.h"

using namespace kinetome;
using Catch::Matchers::Contains;

namespace {

std::vector<SegmentedTake> segments_in(const std::string& lines) {
    return parse_segments_csv("clip,first,end,kind,activity_cluster\n" + lines, "s.csv", 30);
}

std::vector<PrimitivesOfTake> primitives_in(const std::string& lines) {
    return parse_primitives_csv("clip,first,end,activity_first,cluster,label\n" + lines, "p.csv");
}

}  // namespace

TEST_CASE("segments of takes are read, in whatever order they come") {
    const auto takes = segments_in(
        "b,0,9,activity,4\n"
        "'=a,10,14,transition,\n"
        "'=a,14,20,activity,0\n"
        "'=a,0,10,activity,1\n"
        "b,9,12,transition,-1\n");
    REQUIRE(takes.size() == 2);
    CHECK(takes[0].clip == "=a");
    CHECK(takes[0].frames == 20);
    CHECK(takes[0].rate == 30);
    CHECK(takes[0].segments == std::vector<Segment>{{{0, 10}, SegmentKind::activity, 1},
                                                    {{10, 14}, SegmentKind::transition, -1},
                                                    {{14, 20}, SegmentKind::activity, 0}});
    CHECK(takes[1].segments.back().kind == SegmentKind::transition);
}

TEST_CASE("segments that cannot be are refused, naming the line") {
    const auto refused = [](const std::string& lines, const std::string& line,
                            const std::string& reason) {
        INFO(lines);
        CHECK_THROWS_WITH(segments_in(lines), Contains("s.csv:" + line + ": ") && Contains(reason));
        CHECK_THROWS_AS(segments_in(lines), InputError);
    };
    refused("a,0,10,activity,0\na,9,20,activity,0\n", "3", "clip 'a' is cut at frame 9");
    refused("a,0,10,activity,0\na,12,20,activity,0\n", "3", "no segment from frame 10 to 12");
    refused("a,12,20,activity,0\na,1,12,activity,0\n", "3", "no segment from frame 0 to 1");
    refused("a,0,0,activity,0\n", "2", "expected an end behind the first frame 0, found 0");
    refused("a,0,x,activity,0\n", "2", "expected a frame number, found 'x'");
    refused("a,-4,3,activity,0\n", "2", "'-4'");
    refused("a,0,9,walking,0\n", "2", "expected activity or transition, found 'walking'");
    refused("a,0,9,activity,\n", "2", "number of a cluster");
    refused("a,0,9,activity,-1\n", "2", "number of a cluster");
    refused("a,0,9,activity,2147483648\n", "2", "too large");
    refused("a,0,9,transition,3\n", "2", "a transition has no cluster");
    refused("a,0,9,activity\n", "2", "expected 5 fields");
    CHECK_THROWS_WITH(parse_segments_csv("clip,first\n", "s.csv", 30), Contains("s.csv:1: "));
}

TEST_CASE("primitives of takes are read by frame, and do not overlap") {
    const auto takes = primitives_in("a,50,60,40,2,\na,40,50,40,1,\"walk\"\n");
    REQUIRE(takes.size() == 1);
    CHECK(takes[0].primitives == std::vector<RowRange>{{40, 50}, {50, 60}});
    CHECK(takes[0].clusters == std::vector<int32_t>{1, 2});
    CHECK_THROWS_WITH(primitives_in("a,40,50,40,1,\na,49,60,40,2,\n"),
                      Contains("p.csv:3: clip 'a' is cut at frame 49"));
}
