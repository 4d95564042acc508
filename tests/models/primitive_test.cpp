#include "kinetome/models/primitive.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "../../src/models/path_costs.h"
#include "toy_motion.h"

using namespace kinetome;

namespace {

std::vector<Primitive> primitives_of(const MatrixF& rows, const std::vector<Segment>& segments,
                                     PrimitiveMethod method = PrimitiveMethod::cost_ridges) {
    PrimitiveOptions options;
    options.method = method;
    return find_primitives(rows, toy::graph_of(rows), segments, options);
}

std::vector<Segment> one_activity(const MatrixF& rows) {
    return {{{0, rows.rows()}, SegmentKind::activity, 0}};
}

std::vector<int64_t> lengths(const std::vector<Primitive>& primitives) {
    std::vector<int64_t> result;
    for (const Primitive& primitive : primitives) result.push_back(primitive.frames.size());
    return result;
}

bool all_near(const std::vector<int64_t>& values, int64_t expected, int64_t tolerance) {
    return std::ranges::all_of(
        values, [&](int64_t value) { return std::abs(value - expected) <= tolerance; });
}

void check_cover(const std::vector<Primitive>& primitives, const std::vector<Segment>& segments) {
    size_t p = 0;
    for (size_t s = 0; s < segments.size(); ++s) {
        if (segments[s].kind == SegmentKind::transition) continue;
        int64_t next = segments[s].frames.first;
        for (; p < primitives.size() && primitives[p].activity == int32_t(s); ++p) {
            CHECK(primitives[p].frames.first == next);
            CHECK(primitives[p].frames.size() > 0);
            next = primitives[p].frames.end;
        }
        CHECK(next == segments[s].frames.end);
    }
    CHECK(p == primitives.size());
}

/// The least sum over all paths of `steps` steps toward later frames (or earlier, toward -1).
double least_sum(const MatrixF& distances, int64_t i, int64_t j, int64_t toward, int64_t steps) {
    const double here = double(distances(i, j));
    if (steps == 0) return here;
    double best = std::numeric_limits<double>::infinity();
    for (const auto& [rows, columns] : {std::pair{1, 1}, {1, 2}, {2, 1}}) {
        const int64_t to_i = i + toward * rows, to_j = j + toward * columns;
        if (std::min(to_i, to_j) < 0 || std::max(to_i, to_j) >= distances.rows()) continue;
        best = std::min(best, least_sum(distances, to_i, to_j, toward, steps - 1));
    }
    return here + (best < 1e30 ? best : least_sum(distances, i, j, toward, steps - 1));
}

}  // namespace

TEST_CASE("path costs are those of the best of all paths through a pair, whatever rows are asked") {
    const MatrixF rows = toy::Motion().circle(1, 9, 0).raise(1, 8, 2).rows(5);
    const FrameDistances frames(rows, {0, rows.rows()});
    MatrixF distances(17, 17);
    for (int64_t i = 0; i < 17; ++i) frames.from(i, distances.row(i));
    for (int64_t i = 0; i < 17; ++i) {
        for (int64_t j = 0; j < 17; ++j)
            CHECK(distances(i, j) == Approx((rows.row(i) - rows.row(j)).norm()).margin(1e-4));
    }
    constexpr int64_t side = 3;
    for (const RowRange part : {RowRange{0, 17}, RowRange{7, 9}, RowRange{16, 17}}) {
        const MatrixF costs = path_costs(frames, part, side);
        for (int64_t i = part.first; i < part.end; ++i) {
            for (int64_t j = 0; j < 17; ++j) {
                const double expected =
                    (least_sum(distances, i, j, 1, side) + least_sum(distances, i, j, -1, side) -
                     double(distances(i, j))) /
                    (2 * side + 1);
                CHECK(double(costs(i - part.first, j)) == Approx(expected).margin(1e-4));
            }
        }
    }
}

TEST_CASE("a movement is cut where it begins anew, as often as it was made") {
    for (const int64_t cycles : {2, 3, 7}) {
        for (const int64_t period : {20, 33, 80}) {
            CAPTURE(cycles, period);
            const MatrixF rows = toy::Motion().circle(cycles, period, 0).rows();
            const auto primitives = primitives_of(rows, one_activity(rows));
            check_cover(primitives, one_activity(rows));
            CHECK(int64_t(primitives.size()) == cycles);
            CHECK(all_near(lengths(primitives), period, 3));
        }
    }
}

TEST_CASE("a movement that goes back the way it came is one primitive, not two") {
    for (const int64_t period : {30, 60, 100}) {
        CAPTURE(period);
        const MatrixF rows = toy::Motion().raise(4, period, 1).rows();
        const auto primitives = primitives_of(rows, one_activity(rows));
        CHECK(primitives.size() == 4);
        CHECK(all_near(lengths(primitives), period, period / 10));
    }
}

TEST_CASE("a movement that goes faster and faster, or grows, is followed") {
    toy::Motion faster, growing;
    for (const int64_t period : {50, 45, 40, 35, 30, 26}) faster.circle(1, period, 0);
    for (const double radius : {60, 80, 105, 135, 170, 210}) growing.circle(1, 40, 0, radius);
    CHECK(primitives_of(faster.rows(), one_activity(faster.rows())).size() == 6);
    CHECK(primitives_of(growing.rows(), one_activity(growing.rows())).size() == 6);
}

TEST_CASE(
    "what the end of the take cuts off is no primitive, nor part of one, but for the last of it") {
    const MatrixF rows = toy::Motion().circle(4, 40, 0).rows();
    for (const int64_t frames : {125, 130, 140, 145, 152}) {
        CAPTURE(frames);
        const MatrixF cut_off = rows.topRows(frames);
        const auto primitives = primitives_of(cut_off, one_activity(cut_off));
        CHECK(primitives.size() == 3);
        CHECK(all_near(lengths(primitives), 40, 3));
    }
    const MatrixF all_but_complete = rows.topRows(159);
    CHECK(primitives_of(all_but_complete, one_activity(all_but_complete)).size() == 4);
}

TEST_CASE(
    "before another activity a cycle counts when it is half there, not when it has just begun") {
    for (const auto& [frames, count] : {std::pair{130, 3}, {145, 4}}) {
        CAPTURE(frames);
        MatrixF rows(frames + 100, toy::columns);
        rows << toy::Motion().circle(4, 40, 0).rows().topRows(frames),
            toy::Motion().circle(2, 50, 3).rows();
        const std::vector<Segment> segments{{{0, frames}, SegmentKind::activity, 0},
                                            {{frames, frames + 100}, SegmentKind::activity, 1}};
        const auto primitives = primitives_of(rows, segments);
        check_cover(primitives, segments);
        CHECK(std::ranges::count(primitives, 0, &Primitive::activity) == count);
    }
}

TEST_CASE("how long a movement pauses does not decide when it begins anew") {
    toy::Motion motion;
    for (const int64_t pause : {12, 20, 9, 16}) motion.raise(1, 40, 1).hold(pause, 0);
    const MatrixF rows = motion.rows();
    const auto primitives = primitives_of(rows, one_activity(rows));
    CHECK(lengths(primitives).size() == 4);
    if (primitives.size() == 4) {
        CHECK(primitives[1].frames.first == Approx(52).margin(5));
        CHECK(primitives[2].frames.first == Approx(112).margin(5));
        CHECK(primitives[3].frames.first == Approx(161).margin(5));
    }
}

TEST_CASE("a rest after a movement is no further movement, however long it lasts") {
    for (const auto& [before, after] : {std::pair{50, 40}, {60, 60}, {70, 60}, {40, 80}}) {
        CAPTURE(before, after);
        toy::Motion motion;
        motion.hold(before, 0).raise(1, 90, 1).hold(after, 0);
        const int64_t end = before + 90 + after;
        const MatrixF rows = motion.circle(2, 50, 3).rows();
        const auto primitives = primitives_of(rows, {{{0, end}, SegmentKind::activity, 0},
                                                     {{end, end + 100}, SegmentKind::activity, 1}});
        CHECK(std::ranges::count(primitives, 0, &Primitive::activity) == 1);
    }
}

TEST_CASE("where nothing recurs an activity is one primitive: a hold, a single movement") {
    const MatrixF still = toy::Motion().hold(300, 50).rows(0.3);
    const MatrixF once = toy::Motion().circle(1, 80, 0).rows();
    const MatrixF equal = toy::Motion().hold(200, 50).rows(0);
    for (const MatrixF& rows : {still, once, equal}) {
        const auto primitives = primitives_of(rows, one_activity(rows));
        REQUIRE(primitives.size() == 1);
        CHECK(primitives[0].frames == RowRange{0, rows.rows()});
    }
}

TEST_CASE("every activity is cut by itself, transitions not at all") {
    const MatrixF rows = toy::Motion().circle(3, 30, 0).hold(20, 90).raise(2, 50, 2).rows();
    const std::vector<Segment> segments{{{0, 90}, SegmentKind::activity, 0},
                                        {{90, 110}, SegmentKind::transition, -1},
                                        {{110, 210}, SegmentKind::activity, 1}};
    const auto primitives = primitives_of(rows, segments);
    check_cover(primitives, segments);
    CHECK(std::ranges::count(primitives, 0, &Primitive::activity) == 3);
    CHECK(std::ranges::count(primitives, 2, &Primitive::activity) == 2);
}

TEST_CASE("the paper's paths start where a movement begins anew") {
    const MatrixF rows = toy::Motion().circle(4, 30, 0).rows();
    const auto primitives = primitives_of(rows, one_activity(rows), PrimitiveMethod::warping_paths);
    check_cover(primitives, one_activity(rows));
    // The first component begins with the first column that is near frame 0 a period later.
    REQUIRE(primitives.size() == 4);
    for (size_t p = 0; p < 4; ++p) {
        CHECK(primitives[p].frames.first == Approx(30.0 * double(p)).margin(4));
    }
}

TEST_CASE("the paper's paths fail on a movement that goes back the way it came") {
    const MatrixF rows = toy::Motion().raise(4, 40, 1).rows();
    CHECK(primitives_of(rows, one_activity(rows), PrimitiveMethod::warping_paths).size() == 1);
}

TEST_CASE("activities of very few frames are primitives as they are") {
    for (const auto method : {PrimitiveMethod::cost_ridges, PrimitiveMethod::warping_paths}) {
        for (const int64_t frames : {1, 2, 3, 6, 12}) {
            const MatrixF rows = toy::Motion().circle(1, 30, 0).rows().topRows(frames);
            CHECK(primitives_of(rows, one_activity(rows), method).size() == 1);
        }
        const MatrixF none(0, toy::columns);
        CHECK(primitives_of(none, {}, method).empty());
    }
}

TEST_CASE("segments and graphs of another take are refused") {
    const MatrixF rows = toy::Motion().circle(3, 30, 0).rows();
    CHECK_THROWS_AS(primitives_of(rows, {{{0, 91}, SegmentKind::activity, 0}}),
                    std::invalid_argument);
    CHECK_THROWS_AS(primitives_of(rows, {{{9, 9}, SegmentKind::activity, 0}}),
                    std::invalid_argument);
    CHECK_THROWS_AS(find_primitives(rows.topRows(80), toy::graph_of(rows), {}),
                    std::invalid_argument);
}
