// Walks through the cycles of generated takes, whose labels and ends are known.
#include "kinetome/stages/primitive_walk.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "kinetome/base/error.h"
#include "kinetome/synthesis/take.h"

using namespace kinetome;

namespace {

/// Takes of two performers and their cycles, a cluster an activity.
struct Corpus {
    std::map<std::string, Clip> clips;
    std::vector<ClipPrimitive> primitives;

    Corpus() {
        for (int64_t take = 0; take < 6; ++take) {
            const int64_t subject = 1 + take % 2;
            const TakePlan plan = plan_take(take, 3600, subject, take, 5);
            clips[plan.name()] = perform(plan, make_subject(subject, 5), 5);
            for (const SegmentPlan& segment : plan.segments) {
                if (!is_cyclic(segment.activity)) continue;
                for (const CyclePlan& cycle : segment.cycles) {
                    const int64_t end = std::llround(cycle.first + cycle.frames);
                    if (end > segment.end) break;
                    primitives.push_back({plan.name(), std::llround(cycle.first), end,
                                          100 + int32_t(segment.label()),
                                          std::string(activity_name(segment.label()))});
                }
            }
        }
    }
    ClipSource source() const {
        const auto find = [this](const std::string& name) -> const Clip& { return clips.at(name); };
        return {[=](const std::string& name) {
                    return ClipKind{find(name).skeleton->class_name(), find(name).rate};
                },
                find};
    }
    PrimitiveWalk walk(const WalkOptions& options) const {
        return walk_primitives(primitives, source(), options);
    }
};

const Corpus& corpus() {
    static const Corpus made;
    return made;
}

}  // namespace

TEST_CASE("a walk lasts as long as was wanted and moves no joint faster than the takes do") {
    double jolt = 0, jolt_of_cuts = 0;
    for (const uint64_t seed : {1, 2, 3}) {
        const auto walk = corpus().walk({.seconds = 20, .seed = seed});
        CHECK_FALSE(walk.ended_early);
        CHECK(walk.motion.frames() == 2400);
        CHECK(walk.motion.motion.allFinite());
        CHECK(walk.path.size() == walk.nodes.size());
        CHECK(walk.quality.peaks.speed < 1.1 * walk.quality.peaks_in_takes.speed);
        CHECK(walk.quality.peaks.acceleration < 1.1 * walk.quality.peaks_in_takes.acceleration);
        CHECK(walk.quality.pose_step <= walk.quality.pose_step_in_takes);
        // What fading is for; a walk may find its way past the hardest cuts.
        const auto cut = corpus().walk({.seconds = 20, .seed = seed, .fade_seconds = 0});
        jolt = std::max(jolt, walk.quality.peaks.acceleration);
        jolt_of_cuts = std::max(jolt_of_cuts, cut.quality.peaks.acceleration);
    }
    CHECK(jolt_of_cuts > 3 * jolt);
}

TEST_CASE("a seed gives one walk, to the bit") {
    const auto walk = corpus().walk({.seconds = 10, .seed = 7});
    CHECK(walk.motion.motion == corpus().walk({.seconds = 10, .seed = 7}).motion.motion);
    CHECK(walk.motion.motion != corpus().walk({.seconds = 10, .seed = 8}).motion.motion);
}

TEST_CASE("a walk goes on the body that is named, by steps of that body's size") {
    const auto& clips = corpus().clips;
    for (const auto& [name, clip] : clips) {
        const auto walk = corpus().walk({.seconds = 5, .body = name});
        CHECK(walk.body == name);
        CHECK(walk.motion.skeleton == clip.skeleton);
    }
    CHECK_THROWS_AS(corpus().walk({.seconds = 5, .body = "nobody"}), std::out_of_range);
}

TEST_CASE("a walk begins and ends with what is named") {
    const auto& primitives = corpus().primitives;
    const auto first =
        std::ranges::adjacent_find(primitives, [](const auto& one, const auto& next) {
            return one.clip == next.clip && one.label != next.label && next.first - one.end < 240;
        });
    REQUIRE(first != primitives.end());
    const ClipPrimitive& last = *std::next(first);
    const auto walk = corpus().walk({.seconds = 8, .from = first->label, .to = last.label});
    CHECK(walk.path.front().label == first->label);
    CHECK(walk.path.back().label == last.label);
    const auto numbered = corpus().walk({.seconds = 8, .to = std::to_string(last.cluster)});
    CHECK(numbered.path.back().cluster == last.cluster);
}

TEST_CASE("what a walk cannot do is told with what it can") {
    const auto refused = [](const WalkOptions& options) {
        const auto walk = [&] { corpus().walk(options); };
        CHECK_THROWS_AS(walk(), UsageError);
    };
    refused({.seconds = 0});
    refused({.seconds = -3});
    refused({.fade_seconds = -1});
    refused({.from = "swimming"});
    CHECK_THROWS_WITH(
        corpus().walk({.to = "swimming"}),
        Catch::Contains("swimming") && Catch::Contains(corpus().primitives.front().label));
    CHECK_THROWS_WITH(walk_primitives({}, corpus().source(), {}), Catch::Contains("no primitives"));

    // Two islands: nothing follows b but b.
    const std::string clip = corpus().clips.begin()->first;
    const std::vector<ClipPrimitive> islands = {{clip, 0, 50, 0, "a"},
                                                {clip, 50, 100, 0, "a"},
                                                {clip, 900, 950, 1, "b"},
                                                {clip, 950, 999, 1, "b"}};
    const auto walk_islands = [&](const WalkOptions& options) {
        return walk_primitives(islands, corpus().source(), options);
    };
    CHECK_THROWS_WITH(walk_islands({.from = "b", .to = "a"}),
                      Catch::Contains("no path from 'b' to 'a'") && Catch::Contains("to 'b' only"));
    CHECK(walk_islands({.seconds = 3, .from = "b"}).motion.frames() == 360);
}

TEST_CASE("clips of another rate are played at the rate that most primitives have") {
    Corpus mixed = corpus();
    const std::string slow = mixed.primitives.back().clip;
    Clip& clip = mixed.clips.at(slow);
    clip.rate = 60;  // its frames, played at half the speed
    const auto graph = stored_graph(mixed.primitives, mixed.source(), 2);
    CHECK(graph.rate == 120);
    const auto piece = graph.nodes.graph.pieces().back();
    CHECK(piece.first == 2 * mixed.primitives.back().first);
    CHECK(piece.end == 2 * mixed.primitives.back().end);
    CHECK(mixed.walk({.seconds = 5}).motion.rate == 120);
}
