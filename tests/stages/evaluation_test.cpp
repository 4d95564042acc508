#include "kinetome/stages/evaluation.h"

#include <catch2/catch.hpp>

#include "kinetome/base/error.h"
#include "kinetome/stages/aligned_text.h"
#include "kinetome/stages/primitive_evaluation.h"

using namespace kinetome;
using Catch::Matchers::Contains;

namespace {

const std::vector<TruthRow> truth = {{"b", 0, 300, "walk", 280, 320, 2},
                                     {"b", 300, 600, "jump", 600, 600, 3},
                                     {"a", 0, 480, "jump", 480, 480, 4}};

std::vector<SegmentedTake> takes() {
    return {{"a", 480, 120, {{{0, 480}, SegmentKind::activity, 0}}},
            {"b", 600, 120, {{{0, 600}, SegmentKind::activity, 0}}},
            {"c", 100, 120, {{{0, 100}, SegmentKind::activity, 0}}}};
}

const NamedScore& beside(const SegmentEvaluation& evaluation, const std::string& name) {
    for (const NamedScore& one : evaluation.beside) {
        if (one.name == name) return one;
    }
    FAIL("no line is called " << name);
    return evaluation.beside.front();
}

}  // namespace

TEST_CASE("annotated takes are scored by name, with means over all and all but one") {
    const auto annotated = annotate(takes(), truth, "truth.csv");
    const SegmentEvaluation evaluation = evaluate_segments(annotated);
    REQUIRE(evaluation.takes.size() == 2);
    CHECK(evaluation.takes[0].name == "a");
    CHECK(evaluation.takes[0].score.strict == 1.0);
    CHECK(evaluation.takes[1].score.strict == Approx(280 / 600.0));
    CHECK(evaluation.mean.strict == Approx((1 + 280 / 600.0) / 2));
    REQUIRE(evaluation.without.size() == 2);
    CHECK(evaluation.without[0].name == "a");
    CHECK(evaluation.without[0].score.strict == Approx(280 / 600.0));
    CHECK(evaluation.without[1].score.strict == 1.0);
}

TEST_CASE("what blind cuts reach stands beside, the same every time") {
    const auto annotated = annotate(takes(), truth, "truth.csv");
    const SegmentEvaluation evaluation = evaluate_segments(annotated);
    CHECK(beside(evaluation, "annotation, no transitions").score.tolerant == 1.0);
    CHECK(beside(evaluation, "a cut every second").score.counts.activities == 4 + 5);
    CHECK(beside(evaluation, "a cut every 2 seconds").score.counts.activities == 2 + 3);
    // One boundary in the middle of b, where it is; one drawn at random is there now and then.
    CHECK(beside(evaluation, "annotated number, uniform").score.boundary_recall == 1.0);
    const SegmentationScore& random = beside(evaluation, "annotated number, random").score;
    CHECK(random.boundary_recall > 0.5);
    CHECK(random.boundary_recall < 0.9);
    CHECK(random.counts.activities == 3);
    const SegmentationScore& again =
        beside(evaluate_segments(annotated), "annotated number, random").score;
    CHECK(random.strict == again.strict);
}

TEST_CASE("boundaries are tolerated by seconds, whatever the rate") {
    auto late = takes();
    late[1].segments = {{{0, 380}, SegmentKind::activity, 0},
                        {{380, 600}, SegmentKind::activity, 1}};
    const auto recall = [&](double rate, double tolerance) {
        late[1].rate = rate;
        const std::vector<TruthRow> of_b(truth.begin(), truth.begin() + 2);
        return evaluate_segments(annotate(late, of_b, "truth.csv"), {tolerance, 1})
            .mean.boundary_recall;
    };
    CHECK(recall(120, 0.5) == 1.0);  // 60 frames behind the zone
    CHECK(recall(120, 0.4) == 0.0);
    CHECK(recall(60, 0.5) == 0.0);
    CHECK(recall(60, 1.0) == 1.0);
}

TEST_CASE("a clip that is annotated but was not cut is named with its line") {
    const std::vector<TruthRow> unknown = {{"d", 0, 10, "walk", 10, 10, 7}};
    CHECK_THROWS_WITH(annotate(takes(), unknown, "truth.csv"),
                      Contains("truth.csv:7: clip 'd' is annotated"));
    const std::vector<TruthRow> long_one = {{"c", 0, 101, "walk", 101, 101, 8}};
    CHECK_THROWS_WITH(annotate(takes(), long_one, "truth.csv"), Contains("truth.csv:8: "));
}

TEST_CASE("an evaluation as a table has a line a take, a mean and a control") {
    const auto evaluation = evaluate_segments(annotate(takes(), truth, "truth.csv"));
    const std::string csv = write_table(evaluation_table(evaluation), TableFormat::csv);
    CHECK_THAT(csv, Contains("what,name,strict,tolerant,") && Contains("\ntake,a,1,1,") &&
                        Contains("\nmean,,") && Contains("\nmean without,b,1,1,") &&
                        Contains("\nbeside,a cut every second,"));
    const std::string text = aligned_text(evaluation_summary(evaluation));
    CHECK_THAT(text,
               Contains("\nmean without a ") && Contains("  2/3  ") && Contains("  0 (0.0 %)\n"));
}

TEST_CASE("columns of a text are aligned, and hostile names do not reach the terminal") {
    const Table table{{"", "share", "number"},
                      {{std::string("é\x1b[31m"), 0.5, int64_t{12}},
                       {std::string("b"), 1.0, std::string("7/8")}}};
    CHECK(aligned_text(table) ==
          "           share  number\n"
          "é\\x1b[31m  0.500      12\n"
          "b          1.000     7/8\n");
}

TEST_CASE("primitives are scored a take and in all, clusters shared by takes") {
    const auto annotated = annotated_alone(truth, "truth.csv", 120);
    REQUIRE(annotated.size() == 2);
    CHECK(annotated[1].truth.frames() == 600);
    // Cluster 0 is jump in a, walk in b: pure in each take, not in both.
    const std::vector<PrimitivesOfTake> primitives = {
        {"a", {{0, 240}, {240, 480}}, {0, 0}},
        {"b", {{0, 150}, {150, 280}, {320, 600}}, {0, 0, 1}},
        {"z", {{0, 9000}}, {0}}};
    const std::vector<CycleRow> cycles = {
        {"a", 0, 240, "jump", 2}, {"a", 240, 480, "jump", 3}, {"b", 0, 100, "walk", 4}};
    const PrimitiveEvaluation evaluation =
        evaluate_primitives(annotated, primitives, "p.csv", cycles, "c.csv");
    REQUIRE(evaluation.takes.size() == 2);
    CHECK(evaluation.takes[0].score.purity() == 1.0);
    CHECK(evaluation.takes[1].score.purity() == 1.0);
    CHECK(evaluation.total.purity() == Approx(3 / 5.0));
    CHECK(evaluation.total.activities == 2);
    CHECK(evaluation.total.exact == 1);
    CHECK(evaluation.total.within_one == 2);
    CHECK_THAT(write_table(evaluation_table(evaluation), TableFormat::csv),
               Contains("\ntotal,,5,3,2,0.5,1,0.6\n"));
}

TEST_CASE("cycles and primitives that do not fit the annotation are refused") {
    const auto annotated = annotated_alone(truth, "truth.csv", 120);
    const auto with_cycle = [&](const CycleRow& cycle) {
        return evaluate_primitives(annotated, {}, "p.csv", std::vector<CycleRow>{cycle}, "c.csv");
    };
    CHECK_THROWS_WITH(with_cycle({"d", 0, 9, "x", 5}), Contains("c.csv:5: clip 'd'"));
    CHECK_THROWS_WITH(with_cycle({"a", 0, 481, "x", 6}), Contains("c.csv:6: ") && Contains("480"));
    CHECK_THROWS_WITH(with_cycle({"a", 9, 9, "x", 7}), Contains("without frames"));
    const std::vector<PrimitivesOfTake> too_long = {{"a", {{400, 481}}, {0}}};
    CHECK_THROWS_WITH(evaluate_primitives(annotated, too_long, "p.csv", {}, ""),
                      Contains("p.csv: clip 'a'") && Contains("481"));
    CHECK(evaluate_primitives(annotated, {}, "p.csv", {}, "").total.primitives == 0);
}
