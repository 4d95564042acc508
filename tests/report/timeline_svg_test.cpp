#include "kinetome/report/timeline_svg.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string_view>

#include "kinetome/report/xml_text.h"
#include "well_formed.h"

using namespace kinetome;
using Catch::Matchers::Contains;

namespace {

TruthTimeline toy_truth() {
    const std::vector<TruthRow> rows = {{"t", 0, 480, "walk", 420, 540},
                                        {"t", 480, 960, "jump", 960, 960}};
    return truth_timeline(rows, 960, 120, "truth.csv");
}

std::vector<Segment> toy_segments() {
    return {{{0, 400}, SegmentKind::activity, 7},
            {{400, 500}, SegmentKind::transition, -1},
            {{500, 700}, SegmentKind::activity, 3},
            {{700, 960}, SegmentKind::activity, 4}};
}

int64_t count(std::string_view text, std::string_view part) {
    int64_t found = 0;
    for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
    return found;
}

Timeline toy_timeline() {
    const std::vector<RowRange> primitives = {{0, 200}, {200, 400}, {500, 600}, {600, 700}};
    return {"86_01",
            960,
            120,
            {truth_row(toy_truth()),
             segment_row("repetition", toy_segments(), primitives, toy_truth())},
            toy_truth().classes};
}

}  // namespace

TEST_CASE("a cluster is drawn as the class that agrees with it, others by themselves") {
    const TimelineRow row = segment_row("repetition", toy_segments(), {}, toy_truth());
    REQUIRE(row.bars.size() == 4);
    CHECK(row.bars[0].colour == 0);
    CHECK(row.bars[0].name == "walk");
    CHECK(row.bars[1].colour == std::nullopt);
    CHECK(row.bars[2].colour == 2);  // 160 certain frames of jump; cluster 4 has 260
    CHECK(row.bars[2].name == "#3");
    CHECK(row.bars[3].colour == 1);
    CHECK(row.bars[3].name == "jump");
}

TEST_CASE("without annotation a cluster is drawn by its number") {
    const TimelineRow row = segment_row("take", toy_segments(), {});
    REQUIRE(row.bars.size() == 4);
    CHECK(row.bars[0].colour == 7);
    CHECK(row.bars[0].name == "#7");
    CHECK(row.bars[1].colour == std::nullopt);
    CHECK(row.bars[3].colour == 4);
}

TEST_CASE("a tick stands where a primitive begins inside an activity, not at its start") {
    CHECK(toy_timeline().rows[1].ticks == std::vector<int64_t>{200, 600});
}

TEST_CASE("a timeline shows rows, classes, seconds and hatched zones, as well-formed XML") {
    const std::string svg = timeline_svg(toy_timeline());
    CHECK(well_formed(svg));
    CHECK_THAT(svg, Contains(">annotation</text>") && Contains(">repetition</text>") &&
                        Contains("<title>jump, 4.00 s to 8.00 s</title>") &&
                        Contains(">8</text>") && Contains(">boundary uncertain</text>"));
    CHECK(count(svg, "fill=\"url(#zone)\"") == 2);  // the zone and the legend's
    CHECK(svg == timeline_svg(toy_timeline()));
}

TEST_CASE("one class is of one colour in all rows, two are of two") {
    const std::string svg = timeline_svg(toy_timeline());
    CHECK(count(svg, "#77aadd") == 3);  // walk: annotated, found, in the legend
    CHECK(count(svg, "#ee8866") == 3);
    CHECK(count(svg, "#eedd88") == 1);  // the cluster that no class agrees with
    CHECK(count(svg, "#d4d4d4") == 2);  // the transition, and in the legend
}

TEST_CASE("classes beyond the last colour are told apart from the first by dots") {
    Timeline many{"t", 100, 10, {{"row", {}}}};
    for (int32_t i = 0; i < 10; ++i) many.rows[0].bars.push_back({{10 * i, 10 * i + 10}, i, "c"});
    many.colour_names = std::vector<std::string>(10, "c");
    CHECK(count(timeline_svg(many), "url(#dots)") == 4);  // two bars, two in the legend
}

TEST_CASE("hostile names cannot leave their place in a picture") {
    Timeline timeline = toy_timeline();
    timeline.title = "a<script>alert(1)</script>\"&'\x01\xff";
    timeline.rows[0].name = "]]><b>";
    timeline.rows[0].bars[0].name = "</text></svg>";
    const std::string svg = timeline_svg(timeline);
    CHECK(well_formed(svg));
    CHECK(count(svg, "<script") == 0);
    CHECK(count(svg, "<b>") == 0);
    CHECK(count(svg, "</svg>") == 1);
}

TEST_CASE("text for XML loses nothing that XML can hold") {
    CHECK(xml_text("a<b>&\"'") == "a&lt;b&gt;&amp;&quot;&#39;");
    CHECK(xml_text("Läufer \xe6\xad\xa9\xe3\x81\x8f \xf0\x9f\x8f\x83") ==
          "Läufer \xe6\xad\xa9\xe3\x81\x8f \xf0\x9f\x8f\x83");
    const std::string replaced = "\xef\xbf\xbd";
    CHECK(xml_text(std::string_view("\0", 1)) == replaced);
    CHECK(xml_text("\x1b[31m") == replaced + "[31m");
    CHECK(xml_text("\xc0\xaf") == replaced + replaced);                 // an overlong '/'
    CHECK(xml_text("\xed\xa0\x80") == replaced + replaced + replaced);  // half a surrogate pair
    CHECK(xml_text("\xef\xbf\xbf") == replaced + replaced + replaced);  // U+FFFF
    CHECK(xml_text("\xe6\xad") == replaced + replaced);                 // cut off
}

TEST_CASE("an empty take has a picture") {
    CHECK(well_formed(timeline_svg({"empty", 0, 120, {{"annotation", {}}}})));
    CHECK(well_formed(timeline_svg({})));
}
