#include "kinetome/models/activity.h"

#include <catch2/catch.hpp>
#include <limits>

#include "../../src/models/boundaries.h"
#include "../../src/models/foreign_parts.h"
#include "../../src/models/recurrence.h"
#include "../../src/models/repetition_cuts.h"
#include "../../src/models/sameness.h"
#include "../../src/models/transitions.h"
#include "toy_motion.h"

using namespace kinetome;

namespace {

std::vector<Segment> activities_of(const MatrixF& rows, ActivityMethod method) {
    ActivityOptions options;
    options.method = method;
    return find_activities(toy::graph_of(rows), rows, options);
}

bool near(int64_t value, int64_t expected, int64_t tolerance) {
    return std::abs(value - expected) <= tolerance;
}

void check_cover(const std::vector<Segment>& segments, int64_t frames) {
    int64_t next = 0;
    for (const Segment& segment : segments) {
        CHECK(segment.frames.first == next);
        CHECK(segment.frames.size() > 0);
        CHECK((segment.kind == SegmentKind::activity) == (segment.cluster >= 0));
        next = segment.frames.end;
    }
    CHECK(next == frames);
}

Recurrence random_recurrence(int64_t frames, uint64_t item) {
    RandomStream random(8, "recurrence", item);
    MatrixF rows = MatrixF::Zero(frames, 1);
    for (float& value : rows.reshaped()) value = static_cast<float>(random.uniform());
    return recurrence(neighbor_graph(rows, {0.3, frames}, KnnEngine::blocks, 1), 1);
}

/// The score of the cuts that the bits of `cuts` set, from sums over whole blocks.
double score_of(const MatrixD& weights, uint64_t cuts, double segment_cost) {
    double score = 0;
    for (int64_t first = 0, end = 1; first < weights.rows(); ++end) {
        if (end < weights.rows() && !(cuts >> (end - 1) & 1)) continue;
        const int64_t length = end - first;
        score += weights.block(first, first, length, length).sum() / double(length) - segment_cost;
        first = end;
    }
    return score;
}

}  // namespace

TEST_CASE("no way to cut a series repeats more than the cuts found") {
    constexpr int64_t frames = 13;
    constexpr double segment_cost = 0.2;
    for (uint64_t item = 0; item < 10; ++item) {
        const Recurrence recurring = random_recurrence(frames, item);
        MatrixD weights = MatrixD::Zero(frames, frames);
        for (int64_t i = 0; i < frames; ++i) {
            for (size_t e = 0; e < recurring.frames_of(i).size(); ++e)
                weights(i, recurring.frames_of(i)[e]) = recurring.weights_of(i)[e];
        }
        REQUIRE(weights.isApprox(weights.transpose()));
        double best = -std::numeric_limits<double>::infinity();
        for (uint64_t cuts = 0; cuts < uint64_t{1} << (frames - 1); ++cuts)
            best = std::max(best, score_of(weights, cuts, segment_cost));
        double found = 0;
        for (const ScoredSegment& segment : repetition_cuts(recurring, segment_cost)) {
            const int64_t first = segment.frames.first, length = segment.frames.size();
            CHECK(segment.repetitions ==
                  Approx(weights.block(first, first, length, length).sum() / double(length)));
            found += segment.repetitions - segment_cost;
        }
        CHECK(found == Approx(best));
    }
}

TEST_CASE("frames that stay similar are no repetition, whoever of a pair they are nearest to") {
    // 0 1 2 are alike and so are 6 7; 1 and 6 are, too.
    const NeighborGraph graph({0, 2, 5, 7, 8, 9, 10, 13, 15},
                              {0, 1, 0, 1, 2, 1, 2, 3, 4, 5, 1, 6, 7, 6, 7},
                              std::vector<float>(15, 1.0F));
    const Recurrence recurring = recurrence(graph, 40);
    CHECK(recurring.hold == std::vector<int32_t>{2, 3, 2, 1, 1, 1, 2, 2});
    REQUIRE(recurring.frames == std::vector<int32_t>{6, 1});
    CHECK(recurring.weights[0] == Approx(1 / std::sqrt(3.0 * 2.0)));
    CHECK(recurrence(graph, 0).frames.size() == 8);
}

TEST_CASE("who passes through the pose of a rest meets it once, however long it is") {
    // Frames 0 to 7 rest, and 10 passes through their pose.
    NeighborGraph graph;
    {
        std::vector<int64_t> offsets{0};
        std::vector<int32_t> frames;
        for (int32_t i = 0; i < 14; ++i) {
            for (int32_t j = 0; i < 8 && j < 8; ++j) frames.push_back(j);
            if (i < 8) frames.push_back(10);
            if (i == 10) frames.insert(frames.end(), {0, 1, 2, 3, 4, 5, 6, 7});
            if (i >= 8) frames.push_back(i);
            offsets.push_back(static_cast<int64_t>(frames.size()));
        }
        graph = NeighborGraph(offsets, frames, std::vector<float>(frames.size(), 1.0F));
    }
    const Recurrence recurring = recurrence(graph, 3);
    CHECK(recurring.hold == std::vector<int32_t>{4, 5, 6, 7, 7, 6, 5, 4, 1, 1, 1, 1, 1, 1});
    const auto weights = recurring.weights_of(10);
    REQUIRE(weights.size() == 8);
    CHECK(weights[0] == Approx(1 / std::sqrt(4.0)));  // no rest: it may be slow
    CHECK(weights[3] == Approx(1 / 7.0));
}

TEST_CASE("a rest is an activity of its own, though a movement pauses in the same posture") {
    toy::Motion motion;
    motion.hold(120, 0);
    for (int cycle = 0; cycle < 6; ++cycle) motion.raise(1, 36, 4, 300).hold(6, 0);
    const MatrixF rows = motion.rows(0.5);
    const auto segments = activities_of(rows, ActivityMethod::repetition);
    check_cover(segments, rows.rows());
    REQUIRE(segments.size() == 2);
    CHECK(near(segments[0].frames.end, 120, 6));
    CHECK(segments[0].cluster != segments[1].cluster);
}

TEST_CASE(
    "as many or fewer cycles of a movement are the same, a part of it that is shared is not") {
    // Two cycles of two frames, then one that executes the movement, or its first frame alone.
    Recurrence whole{{0, 2, 4, 6, 8, 10, 12},
                     {2, 4, 3, 5, 0, 4, 1, 5, 0, 2, 1, 3},
                     std::vector<double>(12, 1.0),
                     std::vector<int32_t>(6, 1)};
    std::vector<Segment> segments{{{0, 4}, SegmentKind::activity, -1},
                                  {{4, 6}, SegmentKind::activity, -1}};
    cluster_activities(segments, whole, 1);
    CHECK(segments[0].cluster == segments[1].cluster);

    Recurrence part{{0, 2, 3, 5, 6, 8, 8},
                    {2, 4, 3, 0, 4, 1, 0, 2},
                    std::vector<double>(8, 1.0),
                    std::vector<int32_t>(6, 1)};
    cluster_activities(segments, part, 0.6);
    CHECK(segments[0].cluster != segments[1].cluster);
    cluster_activities(segments, part, 0.5);
    CHECK(segments[0].cluster == segments[1].cluster);
}

TEST_CASE("each movement is an activity, and one that comes back is the same") {
    const MatrixF rows = toy::Motion().circle(4, 30, 0).circle(5, 36, 2).circle(3, 30, 0).rows();
    for (const auto method : {ActivityMethod::repetition, ActivityMethod::region_growing}) {
        CAPTURE(int(method));
        const auto segments = activities_of(rows, method);
        check_cover(segments, rows.rows());
        std::vector<Segment> activities;
        for (const Segment& segment : segments) {
            if (segment.kind == SegmentKind::activity) activities.push_back(segment);
        }
        REQUIRE(activities.size() == 3);
        CHECK(near(activities[0].frames.end, 120, 5));
        CHECK(near(activities[1].frames.first, 120, 5));
        CHECK(near(activities[1].frames.end, 300, 5));
        CHECK(near(activities[2].frames.first, 300, 5));
    }
    const auto segments = activities_of(rows, ActivityMethod::repetition);
    CHECK(segments.front().cluster == segments.back().cluster);
    CHECK(segments.front().cluster != segments[segments.size() / 2].cluster);
}

TEST_CASE("a movement that goes back the way it came is one activity") {
    const MatrixF rows = toy::Motion().raise(4, 40, 0).circle(4, 30, 2).raise(3, 48, 4).rows();
    const auto segments = activities_of(rows, ActivityMethod::repetition);
    check_cover(segments, rows.rows());
    int64_t activities = 0;
    for (const Segment& segment : segments) activities += segment.kind == SegmentKind::activity;
    CHECK(activities == 3);
}

TEST_CASE("what happens once, for longer than a transition, is an activity of its own") {
    const MatrixF rows =
        toy::Motion().circle(4, 30, 0).circle(1, 100, 4, 200).circle(4, 30, 2).rows();
    const auto segments = activities_of(rows, ActivityMethod::repetition);
    check_cover(segments, rows.rows());
    REQUIRE(segments.size() == 3);
    CHECK(segments[1].kind == SegmentKind::activity);
    CHECK(near(segments[1].frames.first, 120, 6));
    CHECK(near(segments[1].frames.end, 220, 6));

    const MatrixF shorter =
        toy::Motion().circle(4, 30, 0).circle(1, 40, 4, 200).circle(4, 30, 2).rows();
    const auto with_transition = activities_of(shorter, ActivityMethod::repetition);
    check_cover(with_transition, shorter.rows());
    REQUIRE(with_transition.size() == 3);
    CHECK(with_transition[1].kind == SegmentKind::transition);
}

TEST_CASE("a short movement at the end of a take is an activity, not a transition to nothing") {
    const MatrixF rows = toy::Motion().circle(4, 30, 0).raise(1, 40, 4, 600).rows();
    const auto segments = activities_of(rows, ActivityMethod::repetition);
    check_cover(segments, rows.rows());
    REQUIRE(segments.size() == 2);
    CHECK(segments[1].kind == SegmentKind::activity);
    CHECK(segments[1].cluster != segments[0].cluster);
}

TEST_CASE("what happens once does not hide behind what repeats little") {
    const MatrixF rows = toy::Motion().circle(2, 60, 0).circle(1, 32, 4, 200).rows();
    const Recurrence recurring = recurrence(toy::graph_of(rows), 40);
    REQUIRE(repetition_cuts(recurring, 0.3).size() == 1);
    const auto parts = without_foreign_parts(repetition_cuts(recurring, 0.3), recurring, {}, 30);
    REQUIRE(parts.size() == 2);
    CHECK(near(parts[0].frames.end, 120, 3));
    CHECK(parts[0].repetitions == Approx(1).margin(0.1));
    CHECK(parts[1].repetitions == Approx(0).margin(0.1));

    const auto segments = activities_of(rows, ActivityMethod::repetition);
    check_cover(segments, rows.rows());
    CHECK(segments.front().cluster != segments.back().cluster);
}

TEST_CASE("neither what comes back nor what never repeats is cut for being foreign") {
    const auto parts_of = [](const MatrixF& rows) {
        const Recurrence recurring = recurrence(toy::graph_of(rows), 40);
        const std::vector<ScoredSegment> one{{{0, rows.rows()}, 1}};
        return without_foreign_parts(one, recurring, {}, 30).size();
    };
    CHECK(parts_of(toy::Motion().circle(3, 50, 0).rows()) == 1);
    CHECK(parts_of(toy::Motion().circle(1, 50, 0).hold(20, 0).circle(1, 50, 0).rows()) == 1);
    CHECK(parts_of(toy::Motion().raise(3, 60, 0).rows()) == 1);
    CHECK(parts_of(toy::Motion().circle(1, 60, 0).circle(1, 60, 4, 200).rows()) == 1);
    CHECK(parts_of(toy::Motion().circle(1, 59, 0).rows()) == 1);
    // Parts that ought to last less than a frame have one all the same.
    const Recurrence pair{{0, 1, 2}, {1, 0}, {1, 1}, {1, 1}};
    CHECK(without_foreign_parts({{{0, 2}, 1}}, pair, {}, 0.1).size() == 1);
}

TEST_CASE("a boundary is moved to where the frames are likest their own activities") {
    const MatrixF rows = toy::Motion().circle(4, 30, 0).circle(4, 30, 2).rows();
    for (const int64_t shift : {-9, -4, 0, 5, 10}) {
        CAPTURE(shift);
        std::vector<Segment> segments{{{0, 120 + shift}, SegmentKind::activity, 0},
                                      {{120 + shift, 240}, SegmentKind::activity, 1}};
        refine_boundaries(segments, rows, {}, 30);
        CHECK(near(segments[0].frames.end, 120, 2));
        CHECK(segments[1].frames.first == segments[0].frames.end);
    }
    // No further than its reach, and never where a transition lies between.
    std::vector<Segment> far{{{0, 90}, SegmentKind::activity, 0},
                             {{90, 240}, SegmentKind::activity, 1}};
    refine_boundaries(far, rows, {}, 30);
    CHECK(far[0].frames.end == 100);
    std::vector<Segment> apart{{{0, 125}, SegmentKind::activity, 0},
                               {{125, 126}, SegmentKind::transition, -1},
                               {{126, 240}, SegmentKind::activity, 1}};
    const std::vector<Segment> before = apart;
    refine_boundaries(apart, rows, {}, 30);
    CHECK(apart == before);
}

TEST_CASE("what only one of two activities does not know is no transition") {
    const MatrixF rows = toy::Motion().circle(4, 30, 0).circle(3, 60, 2).rows();
    const Recurrence recurring = recurrence(toy::graph_of(rows), 40);
    const auto boundary_at = [&](int64_t frame) {
        return with_transitions(
            {{{0, frame}, SegmentKind::activity, 0}, {{frame, 300}, SegmentKind::activity, 1}},
            rows, recurring, {}, 30);
    };
    // Forty frames of the second movement are strange to the first, more than a transition takes.
    const auto late = boundary_at(160);
    check_cover(late, 300);
    REQUIRE(late.size() == 2);
    CHECK(near(late[0].frames.end, 120, 2));
}

TEST_CASE("boundaries of activities of a frame or two stay within them") {
    const MatrixF rows = toy::Motion().circle(1, 4, 0).rows();
    std::vector<Segment> segments{{{0, 1}, SegmentKind::activity, 0},
                                  {{1, 2}, SegmentKind::activity, 1},
                                  {{2, 4}, SegmentKind::activity, 0}};
    refine_boundaries(segments, rows, {}, 30);
    check_cover(segments, 4);
}

TEST_CASE("takes without motion, without repetition or without frames are cut as well") {
    for (const auto method : {ActivityMethod::repetition, ActivityMethod::region_growing}) {
        CAPTURE(int(method));
        CHECK(activities_of(MatrixF(0, toy::columns), method).empty());
        for (const int64_t frames : {1, 2, 3, 5, 400}) {
            CAPTURE(frames);
            const MatrixF equal = toy::Motion().hold(frames, 7).rows(0);
            const auto still = activities_of(equal, method);
            check_cover(still, frames);
            CHECK(still.size() == 1);
            MatrixF apart = equal;
            for (int64_t i = 0; i < frames; ++i) apart(i, 0) = 1000.0F * static_cast<float>(i);
            check_cover(activities_of(apart, method), frames);
        }
    }
}

TEST_CASE("a long hold is one activity, however many frames a list of neighbours can hold") {
    const MatrixF rows = toy::Motion().circle(4, 30, 0).hold(600, 150).circle(4, 30, 2).rows();
    const auto segments = activities_of(rows, ActivityMethod::repetition);
    check_cover(segments, rows.rows());
    REQUIRE(segments.size() == 3);
    CHECK(near(segments[1].frames.first, 120, 3));
    CHECK(near(segments[1].frames.end, 720, 3));
}

TEST_CASE("segments keep their places when the rate of the take is another") {
    const auto segments_at = [](int64_t frames_a_cycle, double rate) {
        const MatrixF rows =
            toy::Motion().circle(5, frames_a_cycle, 0).circle(5, frames_a_cycle, 2).rows();
        ActivityOptions options;
        options.rate = rate;
        return find_activities(
            neighbor_graph(rows, {72, static_cast<int64_t>(128 * rate / 30)}, KnnEngine::blocks, 1),
            rows, options);
    };
    const auto slow = segments_at(30, 30), fast = segments_at(120, 120);
    REQUIRE(slow.size() == fast.size());
    for (size_t s = 0; s < slow.size(); ++s) {
        CHECK(slow[s].kind == fast[s].kind);
        CHECK(near(fast[s].frames.end, 4 * slow[s].frames.end, 4));
    }
}

TEST_CASE("a graph of another take is refused") {
    const MatrixF rows = toy::Motion().circle(2, 30, 0).rows();
    CHECK_THROWS_AS(find_activities(toy::graph_of(rows), rows.topRows(10)), std::invalid_argument);
    ActivityOptions options;
    options.rate = 0;
    CHECK_THROWS_AS(find_activities(toy::graph_of(rows), rows, options), std::invalid_argument);
}
