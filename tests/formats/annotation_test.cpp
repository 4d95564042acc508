#include "kinetome/formats/annotation.h"

#include <catch2/catch.hpp>

#include "kinetome/base/error.h"

using namespace kinetome;

TEST_CASE("annotations come back from their files") {
    const std::vector<TruthRow> truth = {{"02_01", 0, 343, "walk", 300, 343},
                                         {"=cmd", 3, 9, "sword, play", 8, 10}};
    const std::vector<TruthRow> read = parse_truth_csv(write_truth_csv(truth), "truth.csv");
    REQUIRE(read.size() == 2);
    for (size_t i = 0; i < 2; ++i) {
        CHECK(read[i].clip == truth[i].clip);
        CHECK(read[i].first == truth[i].first);
        CHECK(read[i].end == truth[i].end);
        CHECK(read[i].label == truth[i].label);
        CHECK(read[i].end_lo == truth[i].end_lo);
        CHECK(read[i].end_hi == truth[i].end_hi);
        CHECK(read[i].line == static_cast<int64_t>(i) + 2);
    }
    CHECK(write_truth_csv({}) == "clip,first,end,label,end_lo,end_hi\n");
    CHECK(write_cycles_csv({{"a", 1, 2, "b"}}) == "clip,first,end,label\na,1,2,b\n");
    CHECK(parse_cycles_csv("clip,first,end,label\na,1,2,b\n", "c.csv").front().label == "b");
}

TEST_CASE("labels are read from every table that begins like one, where there are any") {
    const std::string four = "clip,first,end,label\na,1,2,b\na,2,4,\n";
    const std::string more = "clip,first,end,label,origin,cost\na,1,2,b,known,\na,2,4,,none,\n";
    for (const std::string& text : {four, more, write_truth_csv({{"a", 1, 2, "b", 1, 2}})}) {
        const std::vector<CycleRow> rows = parse_labels_csv(text, "l.csv");
        REQUIRE(rows.size() == 1);
        CHECK(rows[0].clip == "a");
        CHECK(rows[0].first == 1);
        CHECK(rows[0].end == 2);
        CHECK(rows[0].label == "b");
        CHECK(rows[0].line == 2);
    }
    using Catch::Matchers::Contains;
    CHECK_THROWS_WITH(parse_labels_csv("clip,end,first,label\n", "l.csv"), Contains("l.csv:1: "));
    CHECK_THROWS_WITH(parse_labels_csv("clip,first,end\n", "l.csv"), Contains("l.csv:1: "));
    CHECK_THROWS_WITH(parse_labels_csv("", "l.csv"), Contains("l.csv:1: "));
    CHECK_THROWS_WITH(parse_labels_csv("clip,first,end,label,x\na,1,2,b\n", "l.csv"),
                      Contains("l.csv:2: expected 5 fields, found 4"));
    CHECK_THROWS_WITH(parse_labels_csv("clip,first,end,label\na,x,2,b\n", "l.csv"),
                      Contains("'x'"));
}

TEST_CASE("the mark that spreadsheets put before a table is passed over") {
    const std::string mark = "\xEF\xBB\xBF";
    CHECK(parse_labels_csv(mark + "clip,first,end,label\na,1,2,b\n", "l.csv").size() == 1);
    CHECK(parse_cycles_csv(mark + "clip,first,end,label\na,1,2,b\n", "c.csv").size() == 1);
}

TEST_CASE("annotations of another shape are refused, naming the line") {
    using Catch::Matchers::Contains;
    CHECK_THROWS_WITH(parse_truth_csv("", "t.csv"), Contains("t.csv:1: "));
    CHECK_THROWS_WITH(parse_truth_csv("clip,first,end,label\n", "t.csv"), Contains("t.csv:1: "));
    const std::string header = "clip,first,end,label\n";
    CHECK_THROWS_WITH(parse_cycles_csv(header + "a,1,2\n", "c.csv"), Contains("c.csv:2: "));
    CHECK_THROWS_WITH(parse_cycles_csv(header + "a,1,x,b\n", "c.csv"), Contains("'x'"));
    CHECK_THROWS_WITH(parse_cycles_csv(header + "a,-1,2,b\n", "c.csv"), Contains("'-1'"));
    CHECK_THROWS_WITH(parse_cycles_csv(header + "a,3,3,b\n", "c.csv"),
                      Contains("c.csv:2: expected an end after frame 3, found 3"));
    const std::string truth = "clip,first,end,label,end_lo,end_hi\n";
    CHECK_THROWS_WITH(parse_truth_csv(truth + "a,9,3,b,1,2\n", "t.csv"), Contains("t.csv:2: "));
    CHECK_THROWS_WITH(parse_truth_csv(truth + "a,1,3,,1,2\n", "t.csv"),
                      Contains("expected a label"));
}
