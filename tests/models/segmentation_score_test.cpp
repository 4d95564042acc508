#include "kinetome/models/segmentation_score.h"

#include <catch2/catch.hpp>
#include <stdexcept>

#include "kinetome/models/segmentation_controls.h"

using namespace kinetome;

namespace {

constexpr SegmentKind transition = SegmentKind::transition;

/// 100 frames: a until 40, b until 70, a until 100; uncertain from 36 to 44 and from 68 to 72.
TruthTimeline toy_truth() {
    const std::vector<TruthRow> rows = {
        {"t", 0, 40, "a", 36, 44}, {"t", 40, 70, "b", 68, 72}, {"t", 70, 100, "a", 100, 100}};
    return truth_timeline(rows, 100, 10, "truth.csv");
}

Segment activity(int64_t first, int64_t end, int32_t cluster) {
    return {{first, end}, SegmentKind::activity, cluster};
}

SegmentationScore toy_score(const std::vector<Segment>& segments, double tolerance_frames = 0) {
    return score_segments(toy_truth(), segments,
                          {.rate = 10, .boundary_tolerance = tolerance_frames / 10});
}

}  // namespace

TEST_CASE("frames are counted as by hand") {
    // Outside zones: 36 of a, 24 of b, 28 of a. Inside: 8 and 4.
    const SegmentationScore score = toy_score({activity(0, 30, 5),      // 30 a
                                               {{30, 50}, transition},  // 6 a, 8 ?, 6 b
                                               activity(50, 80, 2),     // 18 b, 4 ?, 8 a
                                               activity(80, 100, 5)});  // 20 a
    CHECK(score.strict == Approx(0.30 + 0.08 + 0.18 + 0.20));
    CHECK(score.tolerant == Approx(0.30 + (0.06 + 0.08) + (0.18 + 0.04) + 0.20));
    CHECK(score.lenient == Approx(0.30 + 0.20 + (0.18 + 0.04) + 0.20));
    CHECK(score.purity == Approx((30 + 18 + 20) / 76.0));
    CHECK(score.cluster_purity == Approx((50 + 18) / 76.0));
    // Cluster 5 is a, 2 is b. With zones, frames 68 and 69 of segment 2 are b too.
    CHECK(score.hungarian == Approx(0.30 + 0.20 + 0.20));
    CHECK(score.hungarian_without_zones == Approx((30 + 18 + 20) / 88.0));
    CHECK(score.counts == SegmentationCounts{.frames = 100,
                                             .activities = 3,
                                             .true_activities = 3,
                                             .clusters = 2,
                                             .classes = 2,
                                             .transitions = 1,
                                             .transition_frames = 20,
                                             .boundaries = 2,
                                             .true_boundaries = 2,
                                             .boundaries_found = 1});
}

TEST_CASE("a class is given to one cluster only, so that cutting finely does not pay") {
    const SegmentationScore whole = toy_score({activity(0, 100, 0)});
    CHECK(whole.tolerant == Approx(0.76));
    CHECK(whole.hungarian == Approx(0.70));
    const SegmentationScore fine = score_segments(toy_truth(), cuts_every(100, 1));
    CHECK(fine.tolerant == 1.0);
    CHECK(fine.strict == Approx(0.88));
    CHECK(fine.hungarian == Approx(0.02));
    CHECK(fine.hungarian_without_zones == Approx(2 / 88.0));
}

TEST_CASE("giving a cluster the class of most of its frames may leave another without any") {
    // Cluster 0: 36 a and 24 b, cluster 1: 28 a. One to one, 24 + 28 beat 36 + 0.
    const SegmentationScore score = toy_score({activity(0, 70, 0), activity(70, 100, 1)});
    CHECK(score.hungarian_without_zones == Approx((24 + 28) / 88.0));
}

TEST_CASE("the truth agrees with itself") {
    const SegmentationScore score = score_segments(toy_truth(), segments_of(toy_truth()));
    for (const double share :
         {score.tolerant, score.lenient, score.purity, score.cluster_purity, score.hungarian,
          score.hungarian_without_zones, score.boundary_precision, score.boundary_recall}) {
        CHECK(share == 1.0);
    }
    CHECK(score.strict == Approx(0.88));
}

TEST_CASE("a segment inside a zone is uncertain, not wrong") {
    const std::vector<Segment> segments = {activity(0, 37, 0), activity(37, 43, 1),
                                           activity(43, 70, 2), activity(70, 100, 0)};
    const SegmentationScore score = toy_score(segments);
    CHECK(score.tolerant == 1.0);
    CHECK(score.strict == Approx(0.88));
    CHECK(score.cluster_purity == 1.0);
}

TEST_CASE("a boundary is found in its zone and as far from it as is tolerated") {
    const auto with_boundaries = [](int64_t first, int64_t second, double tolerance) {
        return toy_score(
            {activity(0, first, 0), activity(first, second, 1), activity(second, 100, 0)},
            tolerance);
    };
    CHECK(with_boundaries(36, 72, 0).boundary_recall == 1.0);
    CHECK(with_boundaries(35, 72, 0).boundary_recall == 0.5);
    CHECK(with_boundaries(36, 73, 0).boundary_recall == 0.5);
    CHECK(with_boundaries(33, 75, 3).boundary_recall == 1.0);
    CHECK(with_boundaries(32, 76, 3).boundary_recall == 0.0);
}

TEST_CASE("a zone counts one boundary, a transition is one where it meets a zone") {
    const SegmentationScore doubled = toy_score(
        {activity(0, 38, 0), activity(38, 42, 1), activity(42, 70, 2), activity(70, 100, 0)});
    CHECK(doubled.boundary_recall == 1.0);
    CHECK(doubled.boundary_precision == Approx(2 / 3.0));

    const auto with_transition = [](int64_t first, int64_t end) {
        return toy_score({{{0, 5}, transition},  // at the take's end: no boundary
                          activity(5, first, 0),
                          {{first, end}, transition},
                          activity(end, 100, 1)});
    };
    CHECK(with_transition(30, 36).boundary_recall == 0.5);
    CHECK(with_transition(44, 60).boundary_precision == 1.0);
    CHECK(with_transition(30, 35).boundary_recall == 0.0);
    CHECK(with_transition(45, 60).boundary_precision == 0.0);
    CHECK(with_transition(30, 90).boundary_recall == 0.5);  // one transition, one zone
}

TEST_CASE("a boundary near two zones serves the one that no other can") {
    // With 14 frames tolerated 56 is near both zones, 30 near the first alone.
    const SegmentationScore score =
        toy_score({activity(0, 30, 0), activity(30, 56, 1), activity(56, 100, 2)}, 14);
    CHECK(score.boundary_recall == 1.0);
    CHECK(score.boundary_precision == 1.0);
}

TEST_CASE("where nothing is to be found and nothing is claimed, nothing is wrong") {
    const TruthTimeline truth =
        truth_timeline(std::vector<TruthRow>{{"t", 0, 9, "a", 9, 9}}, 9, 120, "truth.csv");
    const SegmentationScore one = score_segments(truth, uniform_cuts(9, 1));
    CHECK(one.boundary_precision == 1.0);
    CHECK(one.boundary_recall == 1.0);
    const std::vector<Segment> nothing_but_transition = {{{0, 9}, transition}};
    const SegmentationScore none = score_segments(truth, nothing_but_transition);
    CHECK(none.strict == 0.0);
    CHECK(none.tolerant == 1.0);
    CHECK(none.hungarian == 0.0);
    CHECK(none.purity == 0.0);
}

TEST_CASE("segments that do not cover the take once are refused") {
    const TruthTimeline truth = toy_truth();
    const auto refused = [&](const std::vector<Segment>& segments) {
        CHECK_THROWS_AS(score_segments(truth, segments), std::invalid_argument);
    };
    refused({});
    refused({activity(0, 99, 0)});
    refused({activity(0, 50, 0), activity(51, 100, 0)});
    refused({activity(0, 50, 0), activity(49, 100, 0)});
    refused({activity(0, 50, 0), activity(50, 50, 0), activity(50, 100, 0)});
    refused({activity(0, 100, -1)});
}

TEST_CASE("an average has the shares' mean and the counts' sum") {
    const std::vector<SegmentationScore> scores = {toy_score(segments_of(toy_truth())),
                                                   toy_score({activity(0, 100, 0)})};
    const SegmentationScore mean = average(scores);
    CHECK(mean.hungarian == Approx(0.85));
    CHECK(mean.boundary_recall == Approx(0.5));
    CHECK(mean.counts.activities == 4);
    CHECK(mean.counts.true_activities == 6);
    CHECK(mean.counts.frames == 200);
    CHECK(average({}).strict == 0);
}
