#include "kinetome/models/graph_walk.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

/// Clips as words: a letter a piece of a node, 'a' the first; pieces of 10 to 16 frames, gaps of 4
/// where a space stands.
MotionGraph graph_of(const std::vector<std::string>& clips, int32_t nodes) {
    std::vector<MotionPiece> pieces;
    std::vector<int32_t> node_of;
    for (size_t clip = 0; clip < clips.size(); ++clip) {
        int64_t at = 0;
        for (const char letter : clips[clip]) {
            const int64_t frames = 10 + int64_t(pieces.size() % 4) * 2;
            if (letter != ' ') {
                pieces.push_back({int32_t(clip), at, at + frames});
                node_of.push_back(letter - 'a');
            }
            at += letter == ' ' ? 4 : frames;
        }
    }
    return {pieces, node_of, nodes, 4};
}

std::string letters(const GraphWalk& walk) {
    std::string word;
    for (const WalkStep& step : walk.steps) word += char('a' + step.node);
    return word;
}

/// Nodes as given, and each entry is what follows the exit before it.
void check_continuous(const MotionGraph& graph, const GraphWalk& walk) {
    for (size_t i = 0; i < walk.steps.size(); ++i) {
        const WalkStep& step = walk.steps[i];
        CHECK(graph.node_of(step.entry) == step.node);
        CHECK(graph.node_of(step.exit) == step.node);
        if (i + 1 == walk.steps.size()) continue;
        const auto ways = graph.successions(step.node);
        CHECK(std::ranges::count(ways, Succession{step.exit, walk.steps[i + 1].entry}) == 1);
    }
    CHECK(walk.steps.back().entry == walk.steps.back().exit);
}

}  // namespace

TEST_CASE("a walk fills the wanted length by what takes do, its runs last what it says") {
    const auto graph = graph_of({"aab aa", "bb a bab", "abcb"}, 3);
    for (uint64_t seed = 0; seed < 30; ++seed) {
        const auto walk = random_walk(graph, {.frames = 500, .seed = seed});
        CHECK_FALSE(walk.ended_early);
        CHECK(walk.frames >= 500);
        CHECK(walk.frames < 524);  // a piece, a gap and half of what two pieces differ by
        check_continuous(graph, walk);
        for (const double fade : {0.0, 7.0, 100.0}) {
            const auto runs = runs_of_walk(graph, walk.steps, fade);
            CHECK(frames_of_runs(runs) == Approx(walk.frames));
            CHECK(runs.size() <= walk.steps.size());
            for (const MotionRun& run : runs) {
                CHECK(run.end - run.first >= run.fade_in + run.fade_out - 1e-9);
            }
        }
    }
}

TEST_CASE("a seed walks one way, seeds walk different ways") {
    const auto graph = graph_of({"aabaa", "bbabab", "abcb"}, 3);
    std::set<std::string> words;
    for (uint64_t seed = 0; seed < 20; ++seed) {
        const WalkRequest request{.frames = 400, .seed = seed};
        const auto walk = random_walk(graph, request);
        CHECK(walk.steps == random_walk(graph, request).steps);
        words.insert(letters(walk));
    }
    CHECK(words.size() > 15);
}

TEST_CASE(
    "a walk is not caught in a dead end while there is a way out, and settles where there is "
    "most") {
    // d follows a and leads nowhere; e repeats, but is the smaller cycle.
    const auto graph = graph_of({"abab", "aaba", "ad", "ad", "ad", "aee", "cab"}, 5);
    for (uint64_t seed = 0; seed < 30; ++seed) {
        const auto walk = random_walk(graph, {.frames = 600, .seed = seed});
        CHECK_FALSE(walk.ended_early);
        CHECK(letters(walk).find_first_of("cde") == std::string::npos);
        const auto led = random_walk(graph, {.frames = 600, .seed = seed, .from = {2}});
        CHECK(letters(led).front() == 'c');
        CHECK(letters(led).find_first_of("de") == std::string::npos);
    }
}

TEST_CASE("of all successions out of a node each is as likely as any other") {
    const auto graph = graph_of({"ab", "ab", "ab", "ac", "ba", "ca"}, 3);
    const std::string word = letters(random_walk(graph, {.frames = 60000}));
    const auto share = double(std::ranges::count(word, 'b')) /
                       double(std::ranges::count(word, 'b') + std::ranges::count(word, 'c'));
    CHECK(share == Approx(0.75).margin(0.03));
}

TEST_CASE("a walk to a node ends there, and is as long as was wanted") {
    const auto graph = graph_of({"abab", "bcd", "aaba", "da", "ce"}, 5);
    for (uint64_t seed = 0; seed < 30; ++seed) {
        const auto walk = random_walk(graph, {.frames = 300, .seed = seed, .from = {0}, .to = {4}});
        CHECK(letters(walk).front() == 'a');
        CHECK(letters(walk).ends_with("ce"));
        CHECK_FALSE(walk.ended_early);
        CHECK(walk.frames >= 290);
        CHECK(walk.frames < 400);
        check_continuous(graph, walk);
        // With no length wanted, straight away.
        const auto straight = random_walk(graph, {.seed = seed, .from = {0}, .to = {4}});
        CHECK(letters(straight) == "abce");
    }
}

TEST_CASE("a walk goes back rather than over to a piece that does not fit, if it can") {
    // By the second a (piece 3) it gets into b, from which only exits that do not fit lead on.
    const auto graph = graph_of({"aaab", "abba", "ab"}, 2);
    const auto fits = [&](int32_t entry, int32_t exit) {
        return entry == exit || (graph.node_of(entry) == 0 && (entry + exit) % 2 == 0);
    };
    const auto misfits = [&](const GraphWalk& walk) {
        return std::ranges::count_if(
            walk.steps, [&](const WalkStep& step) { return !fits(step.entry, step.exit); });
    };
    const auto excess = [&](int32_t entry, int32_t exit) {
        return fits(entry, exit) ? 0.0 : 1.0 + double(exit);
    };
    int64_t without = 0;
    for (uint64_t seed = 0; seed < 30; ++seed) {
        const WalkRequest request{.frames = 400, .seed = seed, .excess = excess};
        const auto walk = random_walk(graph, request);
        CHECK(misfits(walk) == 0);
        CHECK_FALSE(walk.ended_early);
        CHECK(walk.frames >= 400);
        CHECK(walk.frames < 424);
        check_continuous(graph, walk);
        CHECK(walk.steps == random_walk(graph, request).steps);
        without += misfits(random_walk(graph, {.frames = 400, .seed = seed}));
    }
    CHECK(without > 30);
}

TEST_CASE("where nothing fits a walk takes what fits best") {
    const auto graph = graph_of({"aaa"}, 1);
    const auto walk = random_walk(graph, {.frames = 300, .excess = [](int32_t, int32_t exit) {
                                              return exit == 0 ? 2.0 : 1.0;
                                          }});
    CHECK_FALSE(walk.ended_early);
    for (size_t i = 0; i + 1 < walk.steps.size(); ++i) CHECK(walk.steps[i].exit == 1);
}

TEST_CASE(
    "a walk to a node goes round what does not fit, and where it must not, by what fits best") {
    const std::vector<std::string> clips = {"fabcd", "bacab", "cbdba", "adcbd", "dcabe"};
    const auto graph = graph_of(clips, 6);  // one f to begin with, one e to end with
    const auto pieces = int32_t(graph.pieces().size());
    int64_t round_about = 0, without_fit = 0;
    for (uint64_t seed = 0; seed < 60; ++seed) {
        RandomStream random(seed, "misfits");
        std::vector<double> misfit;
        for (int32_t pair = 0; pair < pieces * pieces; ++pair)
            misfit.push_back(random.below(100) < 20 + seed ? 1 + double(random.below(8)) : 0);
        const auto excess = [&](int32_t entry, int32_t exit) {
            return misfit[size_t(entry * pieces + exit)];
        };
        // Bellman and Ford: the least that getting into each piece exceeds.
        std::vector<double> least(size_t(pieces), HUGE_VAL);
        const int32_t first = graph.members(5).front(), last = graph.members(4).front();
        least[size_t(first)] = 0;
        for (int32_t turn = 0; turn < pieces; ++turn) {
            for (int32_t entry = 0; entry < pieces; ++entry) {
                for (const Succession& way : graph.ways_on(graph.node_of(entry))) {
                    double& there = least[size_t(way.next)];
                    there = std::min(there, least[size_t(entry)] + excess(entry, way.piece));
                }
            }
        }
        const WalkRequest request{.seed = seed, .from = {5}, .to = {4}, .excess = excess};
        const auto walk = random_walk(graph, request);
        check_continuous(graph, walk);
        REQUIRE(walk.steps.back().entry == last);
        const auto excess_of = [&](const GraphWalk& one) {
            double sum = 0;
            for (const WalkStep& step : one.steps) sum += excess(step.entry, step.exit);
            return sum;
        };
        const double found = excess_of(walk);
        CHECK(found == least[size_t(last)] + excess(last, last));
        without_fit += found > 0;
        const auto straight = random_walk(graph, {.seed = seed, .from = {5}, .to = {4}});
        round_about += found == 0 && excess_of(straight) > 0;
    }
    CHECK(round_about > 5);
    CHECK(without_fit > 5);
}

TEST_CASE("a walk that nothing can follow says that it ended early") {
    const auto graph = graph_of({"abc", "bd"}, 4);
    const auto walk = random_walk(graph, {.frames = 1000, .from = {0}});
    CHECK(walk.ended_early);
    CHECK(letters(walk).size() == 3);
    CHECK(walk.frames < 1000);
    check_continuous(graph, walk);
}

TEST_CASE("no walk leads where no path leads") {
    const auto graph = graph_of({"ab", "cd"}, 5);
    CHECK(random_walk(graph, {.frames = 10, .from = {0}, .to = {3}}).steps.empty());
    CHECK(random_walk(graph, {.frames = 10, .from = {4}}).steps.empty());
    CHECK(random_walk(MotionGraph({}, {}, 0, 0), {.frames = 10}).steps.empty());
    CHECK_THROWS_AS(random_walk(graph, {.from = {5}}), std::invalid_argument);
    CHECK_THROWS_AS(random_walk(graph, {.to = {-1}}), std::invalid_argument);
}

TEST_CASE("inside a node a walk goes over in the middle, elsewhere it plays takes as they are") {
    //  a1 b1 (clip 0), a2 b2 after a gap of 10 (clip 1): in at a1, out by a2, then b2.
    const MotionGraph graph({{0, 0, 40}, {0, 40, 60}, {1, 100, 160}, {1, 170, 200}}, {0, 1, 0, 1},
                            2, 10);
    const std::vector<WalkStep> steps = {{0, 0, 2}, {1, 3, 3}};
    CHECK(runs_of_walk(graph, steps, 10) ==
          std::vector<MotionRun>{{0, 0, 24, 0, 8}, {1, 124, 200, 12, 0, 10}});
    CHECK(runs_of_walk(graph, steps, 1000) ==
          std::vector<MotionRun>{{0, 0, 40, 0, 40}, {1, 100, 200, 60, 0, 50}});
    CHECK(runs_of_walk(graph, {{0, 2, 2}, {1, 3, 3}}, 10) == std::vector<MotionRun>{{1, 100, 200}});
}

TEST_CASE("pieces are crossed where they agree best, at moments that answer each other") {
    // The second is the first at two thirds of the speed, but for an arm that differs in all but
    // the third quarter.
    MatrixF entry(80, 2), exit(120, 2);
    for (int i = 0; i < 80; ++i) entry.row(i) << float(i * i) / 10, 0;
    for (int j = 0; j < 120; ++j) {
        const float i = float(j) * 2 / 3;
        exit.row(j) << i * i / 10, i > 40 && i < 60 ? 0.0f : 90.0f;
    }
    const Crossing found = best_crossing(entry, exit, 10, 15);
    CHECK(found.entry > 44);
    CHECK(found.entry < 56);
    CHECK(found.exit == Approx(found.entry * 1.5).margin(2));

    // A fade as long as the pieces leaves no choice, nor do pieces that no warp joins.
    const Crossing whole = best_crossing(entry, exit, 80, 120);
    CHECK(whole.entry == 40);
    CHECK(whole.exit == 60);
    const Crossing unlike = best_crossing(entry.topRows(10), exit, 1, 1);
    CHECK(unlike.entry == 5);
    CHECK(unlike.exit == 60);
    CHECK(unlike.registration.empty());
}

TEST_CASE("a fade is registered by what dynamic time warping finds, from end to end") {
    MatrixF even(80, 1), late(120, 1);
    for (int i = 0; i < 80; ++i) even(i, 0) = float(i / 79.0);
    for (int i = 0; i < 120; ++i) late(i, 0) = float(std::pow(i / 119.0, 1.6));
    const auto registration = best_crossing(even, late, 80, 120).registration;
    REQUIRE(registration.size() > 10);
    CHECK(registration.front() == 0);
    CHECK(registration.back() == 1);
    CHECK(std::ranges::is_sorted(registration));
    const size_t middle = registration.size() / 2;
    CHECK(registration[middle] == Approx(std::pow(0.5, 1 / 1.6)).margin(0.03));
}

TEST_CASE("a crossing near the end of a piece is moved until the fade fits") {
    const MotionGraph graph({{0, 0, 40}, {0, 40, 60}, {1, 100, 160}, {1, 170, 200}}, {0, 1, 0, 1},
                            2, 10);
    const std::vector<WalkStep> steps = {{0, 0, 2}, {1, 3, 3}};
    const auto crossing = [](int32_t, int32_t) { return Crossing{39, 3}; };
    CHECK(runs_of_walk(graph, steps, 10, crossing) ==
          std::vector<MotionRun>{{0, 0, 40, 0, 8}, {1, 100, 200, 12, 0, 10}});
}

TEST_CASE("fades begin and end at whole frames, whatever the crossing") {
    const MotionGraph graph({{0, 0, 41}, {0, 41, 60}, {1, 100, 163}, {1, 170, 200}}, {0, 1, 0, 1},
                            2, 10);
    const std::vector<WalkStep> steps = {{0, 0, 2}, {1, 3, 3}};
    const auto is_whole = [](double frame) {
        return std::abs(frame - std::nearbyint(frame)) < 1e-9;
    };
    for (const double fade : {0.0, 0.3, 7.7, 1000.0}) {
        for (const double at : {0.1, 17.3, 40.6}) {
            const auto runs = runs_of_walk(graph, steps, fade, [&](int32_t, int32_t) {
                return Crossing{at, 1.4 * at, {0, 0.3, 0.45, 1}};
            });
            REQUIRE(runs.size() == 2);
            CAPTURE(fade, at, runs[0].end, runs[0].fade_out, runs[1].first, runs[1].fade_in);
            CHECK(is_whole(runs[0].end - runs[0].fade_out));
            CHECK(is_whole(runs[1].first + runs[1].fade_in));
            CHECK(is_whole(frames_of_runs(runs)));
            CHECK(runs[0].end - runs[0].fade_out >= 0);
            CHECK(runs[1].first + runs[1].fade_in <= 163);
            const double natural =
                natural_fade_frames(runs[0].fade_out, runs[1].fade_in, runs[1].registration);
            CHECK(std::abs(runs[1].fade_frames - natural) < 3);
        }
    }
}

TEST_CASE("a walk goes from one body's motions to another's by linked nodes") {
    MotionGraph graph = graph_of({"abab", "cdcd"}, 4);
    const WalkRequest request{.frames = 60, .from = {0}, .to = {3}};
    CHECK(random_walk(graph, request).steps.empty());
    graph.link(std::vector<NodeLink>{{1, 2}});
    for (uint64_t seed = 0; seed < 10; ++seed) {
        WalkRequest seeded = request;
        seeded.seed = seed;
        const GraphWalk walk = random_walk(graph, seeded);
        REQUIRE(walk.steps.size() > 1);
        CHECK(walk.steps.front().node == 0);
        CHECK(walk.steps.back().node == 3);
        int crossed = 0;
        for (size_t i = 0; i + 1 < walk.steps.size(); ++i) {
            const WalkStep& step = walk.steps[i];
            const auto ways = graph.ways_on(step.node);
            CHECK(std::ranges::count(ways, Succession{step.exit, walk.steps[i + 1].entry}) == 1);
            crossed += step.node == 1 && graph.node_of(step.exit) == 2;
        }
        CHECK(crossed > 0);
    }
}

TEST_CASE("a walk ends in a wanted node by going over from one that is linked with it") {
    MotionGraph graph = graph_of({"ab", "dc"}, 4);
    graph.link(std::vector<NodeLink>{{1, 2}});
    const GraphWalk walk = random_walk(graph, {.frames = 10, .from = {0}, .to = {2}});
    CHECK(letters(walk) == "ab");
    CHECK(graph.node_of(walk.steps.back().entry) == 1);
    CHECK(graph.node_of(walk.steps.back().exit) == 2);
    CHECK(runs_of_walk(graph, walk.steps, 4).back().clip == 1);
}
