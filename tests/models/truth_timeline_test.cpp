#include "kinetome/models/truth_timeline.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "kinetome/base/error.h"

using namespace kinetome;
using Catch::Matchers::Contains;

namespace {

constexpr double rate = 120;

/// The zone that a boundary at frame 1000, between others at 400 and 1600, is given.
RowRange zone_of(int64_t lo, int64_t hi) {
    const std::vector<TruthRow> rows = {{"a", 0, 400, "x", 400, 400},
                                        {"a", 400, 1000, "y", lo, hi},
                                        {"a", 1000, 1600, "x", 1600, 1600},
                                        {"a", 1600, 2000, "y", 2000, 2000}};
    return truth_timeline(rows, 2000, rate, "truth.csv").zones.at(1);
}

TruthTimeline timeline(const std::vector<TruthRow>& rows, int64_t frames) {
    return truth_timeline(rows, frames, rate, "truth.csv");
}

}  // namespace

TEST_CASE("an annotation gives every frame its class and tells which are uncertain") {
    const std::vector<TruthRow> rows = {
        {"a", 0, 4, "walk", 3, 5}, {"a", 4, 7, "jump", 7, 8}, {"a", 7, 9, "walk", 9, 9}};
    const TruthTimeline truth = timeline(rows, 10);
    CHECK(truth.classes == std::vector<std::string>{"walk", "jump"});
    CHECK(truth.class_of_frames() == std::vector<int32_t>{0, 0, 0, 0, 1, 1, 1, 0, 0, 0});
    CHECK(truth.uncertain_frames() == std::vector<char>{0, 0, 0, 1, 1, 0, 0, 1, 0, 0});
    CHECK(truth.frames() == 10);  // the last activity goes on to the end of the take
}

TEST_CASE("a zone that is written wrongly is mended") {
    CHECK(zone_of(950, 1050) == RowRange{950, 1050});
    CHECK(zone_of(1010, 1050) == RowRange{1000, 1050});  // begins behind its boundary
    CHECK(zone_of(950, 990) == RowRange{950, 1000});     // ends before its boundary
    CHECK(zone_of(399, 1040) == RowRange{1000, 1040});   // reaches over the boundary before
    CHECK(zone_of(960, 1601) == RowRange{960, 1000});    // reaches over the boundary after
    // A side of 3 · 50 + 300 frames is as wide as it may be.
    CHECK(zone_of(550, 1050) == RowRange{550, 1050});
    CHECK(zone_of(549, 1050) == RowRange{950, 1050});
    CHECK(zone_of(950, 1451) == RowRange{950, 1050});
}

TEST_CASE("the last activity has no zone, whatever its row says") {
    CHECK(timeline({{"a", 0, 9, "walk", 5, 9}}, 9).zones.empty());
}

TEST_CASE("rows that do not cover a take once are refused, naming file and line") {
    const auto second_row = [](TruthRow row, int64_t frames = 100) {
        row.line = 3;
        return timeline({{"a b", 0, 10, "walk", 10, 10, 2}, row}, frames);
    };
    CHECK_THROWS_WITH(second_row({"a b", 8, 20, "jump", 20, 20}),
                      Contains("truth.csv:3: clip 'a b'") && Contains("until 10"));
    CHECK_THROWS_WITH(second_row({"a b", 12, 20, "jump", 20, 20}),
                      Contains("truth.csv:3: ") && Contains("from frame 10 to 12"));
    CHECK_THROWS_WITH(second_row({"a b", 10, 10, "jump", 10, 10}),
                      Contains("truth.csv:3: ") && Contains("without frames"));
    CHECK_THROWS_WITH(second_row({"a b", 10, 20, "jump", 20, 20}, 19),
                      Contains("truth.csv:3: ") && Contains("19 frames"));
    CHECK_THROWS_WITH(timeline({{"a", 5, 10, "walk", 10, 10, 2}}, 10), Contains("from frame 0 to"));
    CHECK_THROWS_AS(second_row({"a b", 8, 20, "jump", 20, 20}), InputError);
    CHECK_NOTHROW(second_row({"a b", 10, 20, "jump", 20, 20}));
}

TEST_CASE("a take without rows has no frames") {
    CHECK(timeline({}, 10).frames() == 0);
}
