// What segments made blindly reach on annotated takes. The figures they must come near were
// reached by an independent implementation of the same metric on these and two more takes.
#include "kinetome/models/segmentation_controls.h"

#include <catch2/catch.hpp>
#include <functional>
#include <map>

#include "kinetome/base/file.h"
#include "kinetome/models/segmentation_score.h"
#include "support/test_corpus.h"

using namespace kinetome;

namespace {

std::vector<TruthTimeline> annotated_takes(const std::filesystem::path& corpus) {
    const std::string path = (corpus / "labels" / "truth.csv").string();
    std::map<std::string, std::vector<TruthRow>> rows;
    for (const TruthRow& row : parse_truth_csv(read_source_file(path), path)) {
        rows[row.clip].push_back(row);
    }
    std::vector<TruthTimeline> takes;
    for (const auto& [clip, of_clip] : rows) {
        takes.push_back(truth_timeline(of_clip, of_clip.back().end, 120, path));
    }
    return takes;
}

using Control = std::function<std::vector<Segment>(const TruthTimeline&)>;

SegmentationScore mean_score(const std::vector<TruthTimeline>& takes, const Control& control) {
    std::vector<SegmentationScore> scores;
    for (const TruthTimeline& truth : takes)
        scores.push_back(score_segments(truth, control(truth)));
    return average(scores);
}

int64_t activities(const TruthTimeline& truth) {
    return static_cast<int64_t>(truth.activities.size());
}

}  // namespace

TEST_CASE("blind cuts reach what the metric is known to give them") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    const auto takes = annotated_takes(*corpus);
    REQUIRE(takes.size() == 5);

    const auto every_second =
        mean_score(takes, [](const auto& truth) { return cuts_every(truth.frames(), 120); });
    CHECK(every_second.strict == Approx(0.870).margin(0.02));
    CHECK(every_second.tolerant == Approx(0.999).margin(0.01));
    CHECK(every_second.hungarian_without_zones == Approx(0.191).margin(0.05));

    const auto every_other_second =
        mean_score(takes, [](const auto& truth) { return cuts_every(truth.frames(), 240); });
    CHECK(every_other_second.strict == Approx(0.852).margin(0.02));
    CHECK(every_other_second.tolerant == Approx(0.981).margin(0.01));

    const auto no_transitions = mean_score(takes, segments_of);
    CHECK(no_transitions.strict == Approx(0.871).margin(0.02));
    CHECK(no_transitions.tolerant == 1.0);

    const auto uniform = mean_score(
        takes, [](const auto& truth) { return uniform_cuts(truth.frames(), activities(truth)); });
    CHECK(uniform.strict == Approx(0.716).margin(0.02));
    CHECK(uniform.tolerant == Approx(0.846).margin(0.02));
    CHECK(uniform.hungarian == Approx(0.671).margin(0.02));
    CHECK(uniform.hungarian_without_zones == Approx(0.712).margin(0.02));
    CHECK(uniform.boundary_precision == uniform.boundary_recall);

    std::vector<SegmentationScore> draws;
    RandomStream random(1, "random-cuts");
    for (int draw = 0; draw < 50; ++draw) {
        draws.push_back(mean_score(takes, [&](const auto& truth) {
            return random_cuts(truth.frames(), activities(truth), random);
        }));
    }
    CHECK(average(draws).strict == Approx(0.599).margin(0.02));
    CHECK(average(draws).tolerant == Approx(0.728).margin(0.02));
}

TEST_CASE("cuts cover the take, as many as were asked for") {
    RandomStream random(2, "random-cuts");
    for (const int64_t count : {1, 2, 7, 10}) {
        const TruthTimeline truth =
            truth_timeline(std::vector<TruthRow>{{"t", 0, 10, "a", 10, 10}}, 10, 120, "truth.csv");
        for (const auto& segments : {uniform_cuts(10, count), random_cuts(10, count, random)}) {
            CHECK(static_cast<int64_t>(segments.size()) == count);
            CHECK(score_segments(truth, segments).counts.clusters == count);  // refuses gaps
        }
    }
    CHECK(cuts_every(10, 4).back().frames == RowRange{8, 10});
    CHECK(cuts_every(8, 4).size() == 2);
    CHECK_THROWS_AS(uniform_cuts(3, 4), std::invalid_argument);
    CHECK_THROWS_AS(random_cuts(3, 0, random), std::invalid_argument);
    CHECK_THROWS_AS(cuts_every(3, 0), std::invalid_argument);
}
