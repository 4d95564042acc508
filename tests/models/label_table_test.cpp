#include "kinetome/models/label_table.h"

#include <catch2/catch.hpp>

using namespace kinetome;

TEST_CASE("labels are found, correct or missed, abstentions missed") {
    const std::vector<int32_t> truth{0, 0, 0, 0, 1, 1, -1, 2};
    const std::vector<int32_t> given{0, 0, -1, 1, 1, -1, 1, -1};
    const LabelTable table = label_table(truth, given, 4);
    REQUIRE(table.labels.size() == 4);
    CHECK(table.labels[0] == LabelCounts{0, 2, 2, 2});
    CHECK(table.labels[1] == LabelCounts{0, 2, 1, 1});
    CHECK(table.labels[2] == LabelCounts{0, 0, 0, 1});
    CHECK(table.labels[3] == LabelCounts{});
    CHECK(table.all == LabelCounts{0, 4, 3, 4});
    CHECK(table.labels[0].precision() == 1);
    CHECK(table.labels[0].recall() == 0.5);
    CHECK(table.labels[1].precision() == 0.5);
    CHECK(table.labels[2].recall() == 0);
    CHECK(table.labels[3].precision() == 1);
    CHECK(table.labels[3].recall() == 1);
    CHECK_THROWS_AS(label_table(truth, given, 2), std::invalid_argument);
    CHECK_THROWS_AS(label_table(truth, std::vector<int32_t>{0}, 4), std::invalid_argument);
}

TEST_CASE("with each take that becomes known its labels are found in the others") {
    // Takes of one movement each, a place of its own; the last two takes are asked for.
    const std::vector<float> places{0, 500, 1000, 0, 1000};
    MatrixF features(100, 2);
    std::vector<CorpusPrimitive> primitives;
    std::vector<int32_t> labels;
    for (int64_t clip = 0; clip < 5; ++clip) {
        features.middleRows(20 * clip, 20).setConstant(places[size_t(clip)]);
        for (int64_t half = 0; half < 2; ++half) {
            const int64_t first = 20 * clip + 10 * half;
            primitives.push_back({clip, {first, first + 10}});
            labels.push_back(static_cast<int32_t>(places[size_t(clip)] / 500));
        }
    }
    const std::vector<int64_t> known{0, 1, 2};
    const auto tables = label_tables(features, primitives, labels, 3, known, {}, 2);
    REQUIRE(tables.size() == 3);
    CHECK(tables[0].all == LabelCounts{2, 2, 2, 2});
    CHECK(tables[1].all == LabelCounts{4, 2, 2, 2});
    CHECK(tables[2].all == LabelCounts{6, 4, 4, 0});
    CHECK(tables[1].labels[1] == LabelCounts{2, 0, 0, 0});
    CHECK(tables[2].labels[2] == LabelCounts{2, 2, 2, 0});
    CHECK_THROWS_AS(label_tables(features, primitives, std::vector<int32_t>{0}, 3, known, {}, 1),
                    std::invalid_argument);
}
