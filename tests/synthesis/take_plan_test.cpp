#include "kinetome/synthesis/take_plan.h"

#include <catch2/catch.hpp>
#include <numeric>
#include <set>

#include "kinetome/synthesis/corpus_generator.h"

using namespace kinetome;

TEST_CASE("takes last 5 to 60 seconds, 1,570 frames in the mean, and add up exactly") {
    for (const int64_t frames : {2'500'000, 100'001, 7'201, 1'199, 601}) {
        const std::vector<int64_t> lengths = take_lengths(frames, 1);
        CHECK(std::accumulate(lengths.begin(), lengths.end(), int64_t{0}) == frames);
        for (const int64_t length : lengths) {
            CHECK(length >= 600);
            CHECK(length <= 7200);
        }
    }
    const auto takes = static_cast<double>(take_lengths(2'500'000, 1).size());
    CHECK(2'500'000 / takes == Approx(1570).epsilon(0.05));
}

TEST_CASE("fewer frames than a take needs make one short take") {
    CHECK(take_lengths(1, 1) == std::vector<int64_t>{1});
    CHECK(take_lengths(599, 1) == std::vector<int64_t>{599});
    CHECK(take_lengths(0, 1).empty());
}

TEST_CASE("every subject performs, about 12 takes each unless told otherwise") {
    CHECK(subject_count(120, 0) == 10);
    CHECK(subject_count(3, 0) == 1);
    CHECK(subject_count(3, 99) == 3);
    for (const int64_t subjects : {1, 7, 100}) {
        std::set<int64_t> seen;
        for (int64_t take = 0; take < 100; ++take)
            seen.insert(subject_of_take(take, 100, subjects));
        CHECK(static_cast<int64_t>(seen.size()) == subjects);
        CHECK(*seen.begin() == 1);
        CHECK(*seen.rbegin() == subjects);
    }
}

TEST_CASE("segments tile each take, blends lie inside and do not meet") {
    for (int64_t index = 0; index < 150; ++index) {
        const int64_t frames = 600 + 40 * index;
        const TakePlan plan = plan_take(index, frames, 1 + index / 12, 1, 5);
        int64_t at = 0;
        int64_t blended = 0;
        for (const SegmentPlan& segment : plan.segments) {
            CHECK(segment.first == at);
            CHECK(segment.end > segment.first);
            CHECK(segment.blend_first >= blended);
            CHECK(segment.blend_first <= segment.end);
            CHECK(segment.blend_end >= segment.end);
            CHECK(segment.blend_end <= frames);
            const double seconds =
                static_cast<double>(segment.blend_end - segment.blend_first) / synthesis_rate;
            CHECK((segment.end == frames ? seconds == 0 : seconds >= 0.3 && seconds <= 0.62));
            at = segment.end;
            blended = segment.blend_end;
        }
        CHECK(at == frames);
    }
}

TEST_CASE("neighbouring segments are of different activities") {
    for (int64_t index = 0; index < 100; ++index) {
        const TakePlan plan = plan_take(index, 3000, 1, 1, 6);
        for (size_t i = 1; i < plan.segments.size(); ++i)
            CHECK(plan.segments[i].label() != plan.segments[i - 1].label());
    }
}

TEST_CASE("cycles lie inside a segment of their label and follow each other") {
    int64_t cycles = 0;
    for (int64_t index = 0; index < 100; ++index) {
        const Annotations rows = annotate(plan_take(index, 2000, 1, 1, 7));
        int64_t last_end = 0;
        for (const CycleRow& cycle : rows.cycles) {
            CHECK(cycle.first >= last_end);
            CHECK(cycle.end > cycle.first + 30);
            last_end = cycle.end;
            int inside = 0;
            for (const TruthRow& row : rows.truth)
                inside +=
                    row.first <= cycle.first && cycle.end <= row.end && row.label == cycle.label;
            CHECK(inside == 1);
            ++cycles;
        }
    }
    CHECK(cycles > 500);
}

TEST_CASE("a left-handed performer's segments are labelled by what is seen") {
    SegmentPlan segment;
    for (const auto& [done, seen] : {std::pair(Activity::punch_left, Activity::punch_right),
                                     std::pair(Activity::punch_right, Activity::punch_left),
                                     std::pair(Activity::kick_left, Activity::kick_right),
                                     std::pair(Activity::kick_right, Activity::kick_left),
                                     std::pair(Activity::walk, Activity::walk)}) {
        segment.activity = done;
        segment.mirrored = false;
        CHECK(segment.label() == done);
        segment.mirrored = true;
        CHECK(segment.label() == seen);
    }
}

TEST_CASE("every activity is performed, with either hand and foot") {
    std::set<std::string> labels;
    for (int64_t index = 0; index < 200; ++index) {
        for (const TruthRow& row : annotate(plan_take(index, 2000, 1, 1, 8)).truth)
            labels.insert(row.label);
    }
    CHECK(labels.size() == static_cast<size_t>(Activity::count));
}
