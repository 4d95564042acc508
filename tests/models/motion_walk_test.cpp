#include "kinetome/models/motion_walk.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "features/small_body.h"
#include "kinetome/models/motion_blend.h"

using namespace kinetome;
using namespace small_body;

namespace {

constexpr double tau = 2 * std::numbers::pi;

std::shared_ptr<const Skeleton> shared_body() {
    static const auto body = std::make_shared<const Skeleton>(skeleton());
    return body;
}

Clip clip_of(MatrixF motion) {
    return {shared_body(), std::move(motion), 120.0};
}

/// Strides of `period` frames, `speed` cm a frame along +z, swung by `swing` radians.
MatrixF strides(int frames, double period, double speed, double swing) {
    MatrixF motion = MatrixF::Zero(frames, skeleton().dof_count());
    for (int i = 0; i < frames; ++i) {
        const double phase = tau * i / period;
        motion(i, root_y) = float(95 + 2 * std::cos(2 * phase));
        motion(i, root_z) = float(speed * i);
        for (int dof = 6; dof < motion.cols(); dof += 3) {
            motion(i, dof) = float(swing * std::sin(phase + dof));
        }
    }
    return motion;
}

double largest_step(const Clip& clip) {
    const MatrixF at = joint_positions(clip);
    double largest = 0;
    for (int64_t i = 1; i < at.rows(); ++i) {
        for (int64_t j = 0; j < at.cols(); j += 3) {
            largest = std::max(largest, double((at.row(i) - at.row(i - 1)).segment<3>(j).norm()));
        }
    }
    return largest;
}

void check_equal(const MatrixF& found, const MatrixF& expected, double within) {
    REQUIRE(found.rows() == expected.rows());
    CHECK(double((found - expected).cwiseAbs().maxCoeff()) < within);
}

MotionRun whole(int32_t clip, int64_t frames) {
    return {.clip = clip, .first = 0, .end = double(frames)};
}

}  // namespace

TEST_CASE("a clip blended with itself is the clip, whatever the weights") {
    const Clip clip = clip_of(wandering(400));
    const Clip elsewhere = clip_of(turned_and_moved(wandering(400), 2.2, 300, -50));
    const auto blended = blend_motions(std::vector<BlendPart>{
        {&clip, 0, 400, 0.5}, {&elsewhere, 0, 400, 2.0}, {&clip, 0, 400, 0}});
    check_equal(joint_positions(blended), joint_positions(clip), 5e-3);
}

TEST_CASE("registered parts of a blend are seen together where they answer each other") {
    MatrixF early = MatrixF::Zero(81, skeleton().dof_count()), late = early;
    for (int64_t i = 0; i < 81; ++i) {
        early(i, 6) = std::max(0.0F, 1 - std::abs(float(i - 20)) / 10);
        late(i, 6) = std::max(0.0F, 1 - std::abs(float(i - 60)) / 10);
    }
    const Clip a = clip_of(early), b = clip_of(late);
    std::vector<BlendPart> parts = {{&a, 0, 80, 1}, {&b, 0, 80, 1}};
    CHECK(blend_motions(parts).motion.col(6).maxCoeff() < 0.6F);
    parts[1].registration = {0, 0.75, 0.85, 0.92, 1};
    const Clip together = blend_motions(parts);
    CHECK(together.motion.col(6).maxCoeff() > 0.9F);
    CHECK(together.frames() == 80);
    parts[1].registration = {0, 0.75, 0.6, 1};
    CHECK_THROWS_AS(blend_motions(parts), std::invalid_argument);
}

TEST_CASE("a single run is its frames of the clip, standing where they stood") {
    const Clip clip = clip_of(wandering(300));
    const Clip played = play_runs(std::vector{clip}, std::vector<MotionRun>{{0, 40, 260}});
    check_equal(joint_positions(played), joint_positions(clip).middleRows(40, 220), 5e-3);
}

TEST_CASE("weights mix rotations, heights and steps, and lengths") {
    MatrixF still = MatrixF::Zero(100, skeleton().dof_count()), bent = still.topRows(60);
    still.col(root_z) = VectorF::LinSpaced(100, 0, 99);         // 1 cm a frame along +z
    bent.col(root_x) = VectorF::LinSpaced(60, 500, 500 + 177);  // 3 cm a frame along +x …
    bent.col(root_yaw).setConstant(float(tau / 4));             // … which is forward
    bent.col(root_y).setConstant(10);
    bent.col(6).setConstant(1);
    const Clip a = clip_of(still), b = clip_of(bent);
    const Clip mixed = blend_motions(std::vector<BlendPart>{{&a, 0, 100, 3}, {&b, 0, 60, 1}});
    REQUIRE(mixed.frames() == 90);
    // In 90 frames the parts go 100 · 1 and 60 · 3 cm.
    const double step = (3 * 100.0 / 90 + 180.0 / 90) / 4;
    for (int64_t i = 0; i < 90; ++i) {
        CHECK(mixed.motion(i, 6) == Approx(0.25).margin(1e-6));
        CHECK(mixed.motion(i, root_y) == Approx(2.5));
        CHECK(mixed.motion(i, root_z) == Approx(double(i) * step).margin(1e-3));
        CHECK(mixed.motion(i, root_x) == Approx(0).margin(1e-3));
    }
}

TEST_CASE("the next piece goes on where the last one is, the way it faces") {
    MatrixF turning = MatrixF::Zero(100, skeleton().dof_count());
    turning.col(root_yaw) = VectorF::LinSpaced(100, 0, float(tau / 4));
    const Clip turn = clip_of(turning);
    // Forward at 2 cm a frame, somewhere else on the floor and facing away.
    const Clip walk = clip_of(turned_and_moved(strides(200, 50, 2, 0.4), -2.9, 1000, 400));
    const std::vector<MotionPiece> pieces = {{0, 0, 100}, {1, 20, 180}};
    const Clip joined = play_runs(std::vector{turn, walk}, runs_of_pieces(pieces, 0));
    REQUIRE(joined.frames() == 260);
    CHECK(joined.motion(259, root_x) == Approx(2 * 160).epsilon(1e-3));
    CHECK(joined.motion(259, root_z) == Approx(0).margin(0.5));
    const auto smooth = play_runs(std::vector{turn, walk}, runs_of_pieces(pieces, 36));
    REQUIRE(smooth.frames() == 260);
    CHECK(smooth.motion(259, root_x) == Approx(2 * 160).epsilon(0.02));
    CHECK(std::abs(smooth.motion(259, root_z)) < 4);
}

TEST_CASE("no joint moves faster over a seam than in the sources, unlike without a fade") {
    const std::vector<Clip> clips = {clip_of(strides(400, 100, 1.2, 0.4)),
                                     clip_of(strides(400, 92, 1.3, 0.5)), clip_of(wandering(10))};
    const std::vector<MotionPiece> pieces = {{0, 100, 200}, {1, 92, 184}, {1, 0, 92},
                                             {0, 100, 150}, {1, 46, 138}, {0, 0, 100}};
    const double allowed = std::max(largest_step(clips[0]), largest_step(clips[1]));
    CHECK(largest_step(play_runs(clips, runs_of_pieces(pieces, 36))) < 1.05 * allowed);
    CHECK(largest_step(play_runs(clips, runs_of_pieces(pieces, 0))) > 1.5 * allowed);
}

TEST_CASE("pieces that go on in their own clip are played as they were, fades or none") {
    const Clip clip = clip_of(wandering(300));
    const std::vector<MotionPiece> pieces = {{0, 10, 100}, {0, 100, 101}, {0, 101, 250}};
    const auto runs = runs_of_pieces(pieces, 36);
    CHECK(runs == std::vector<MotionRun>{{0, 10, 250}});
}

TEST_CASE("pieces shorter than a fade keep their order and their length") {
    const std::vector<Clip> clips = {clip_of(wandering(30)), clip_of(wandering(3))};
    const std::vector<MotionPiece> pieces = {{0, 0, 1},  {1, 0, 2},   {0, 20, 21}, {1, 1, 3},
                                             {0, 5, 30}, {0, 29, 30}, {1, 0, 3}};
    const auto runs = runs_of_pieces(pieces, 40);
    CHECK(frames_of_runs(runs) == Approx(35));
    for (const MotionRun& run : runs) {
        CHECK(run.end - run.first >= run.fade_in + run.fade_out - 1e-9);
    }
    const Clip played = play_runs(clips, runs);
    CHECK(played.frames() == 35);
    CHECK(played.motion.allFinite());
}

TEST_CASE("beyond the end of its clip a run holds the pose and goes on as it went") {
    const Clip clip = clip_of(strides(50, 40, 2, 0.4));
    const Clip played = play_runs(std::vector{clip}, std::vector<MotionRun>{{0, -5, 60}});
    REQUIRE(played.frames() == 65);
    CHECK(played.motion.row(0).tail(15) == played.motion.row(5).tail(15));
    CHECK(played.motion.row(64).tail(15) == played.motion.row(54).tail(15));
    for (int64_t i = 1; i < 65; ++i) {
        CHECK(played.motion(i, root_z) - played.motion(i - 1, root_z) == Approx(2).epsilon(1e-3));
    }
}

TEST_CASE("a fade between motions of unlike length begins and ends at the speed they have") {
    const Clip slow = clip_of(strides(200, 100, 1, 0.4)), fast = clip_of(strides(200, 50, 1, 0.4));
    const std::vector<MotionRun> runs = {{0, 0, 100, 0, 100}, {1, 0, 50, 50, 0}};
    CHECK(frames_of_runs(runs) == Approx(75));
    const Clip played = play_runs(std::vector{slow, fast}, runs);
    REQUIRE(played.frames() == 75);
    const auto step = [&](int64_t i) {
        return double(played.motion(i, root_z)) - double(played.motion(i - 1, root_z));
    };
    CHECK(step(1) == Approx(1).epsilon(0.02));
    CHECK(step(74) == Approx(1).epsilon(0.02));
    for (int64_t i = 2; i < 75; ++i) CHECK(std::abs(step(i) - step(i - 1)) < 0.05);
    // Both sides pass their cycle in equal shares, so that the arms swing once.
    CHECK(largest_step(played) < 1.1 * std::max(largest_step(slow), largest_step(fast)));
}

TEST_CASE("a fade that is to last longer is slower in between, and no less smooth at its ends") {
    const Clip walk = clip_of(strides(200, 100, 1, 0.4));
    const std::vector<MotionRun> runs = {{0, 0, 100, 0, 60}, {0, 40, 140, 60, 0, 90}};
    CHECK(frames_of_runs(runs) == Approx(170));
    const Clip played = play_runs(std::vector{walk}, runs);
    REQUIRE(played.frames() == 170);
    const auto step = [&](int64_t i) {
        return double(played.motion(i, root_z)) - double(played.motion(i - 1, root_z));
    };
    for (int64_t i = 1; i < 170; ++i) {
        const bool fades = i >= 40 && i <= 130;
        CHECK(step(i) < 1 + 1e-3);
        CHECK(step(i) > (fades ? 0.5 : 1 - 1e-3));
        if (i > 1) CHECK(std::abs(step(i) - step(i - 1)) < 0.03);
    }
    CHECK(step(85) < 0.6);
}

TEST_CASE("feet that stand on both sides of a fade stay where they are, feet in the air do not") {
    // Two bodies that stand still, one leaning forward, one back: their feet are under different
    // places of the root.
    MatrixF forward = MatrixF::Zero(120, skeleton().dof_count()), back = forward;
    forward.col(root_pitch).setConstant(0.1f);
    back.col(root_pitch).setConstant(-0.1f);
    const std::vector<Clip> clips = {clip_of(forward), clip_of(back)};
    const std::vector<MotionRun> runs = {{0, 0, 100, 0, 60}, {1, 20, 120, 60, 0}};
    const auto standing_at = [](double support) {
        return ClipSupports(2, std::vector<FootSupport>(120, {support, support, 0, 0}));
    };
    const auto farthest = [](const Clip& played) {
        const MatrixF at = joint_positions(played);
        const auto ankle = at.middleCols(3 * skeleton().role(JointRole::left_ankle), 3);
        const MatrixF from_start = ankle.rowwise() - ankle.row(0);
        return double(from_start.col(2).cwiseAbs().maxCoeff());
    };
    CHECK(farthest(play_runs(clips, runs, standing_at(0))) > 10);
    CHECK(farthest(play_runs(clips, runs)) == farthest(play_runs(clips, runs, standing_at(0))));
    CHECK(farthest(play_runs(clips, runs, standing_at(1))) < 0.1);
    // Where one clip is seen alone it is as it was, however its feet slide.
    const Clip gliding = clip_of(strides(100, 50, 0.2, 0.1));
    const Clip alone = play_runs(std::vector{gliding, gliding},
                                 std::vector<MotionRun>{{0, 10, 60}, {1, 60, 90}}, standing_at(1));
    check_equal(joint_positions(alone), joint_positions(gliding).middleRows(10, 80), 5e-3);
}

TEST_CASE("a registered fade blends what answers each other, an even one what does not") {
    // The same movement, once at one speed, once slow at first and fast then.
    MatrixF even = MatrixF::Zero(200, skeleton().dof_count()), late = even;
    const int dof = 6;
    const auto bump = [](double share) {
        return float(std::exp(-std::pow((share - 0.5) / 0.06, 2)));
    };
    std::vector<double> registration;  // of even shares of the first
    for (int i = 0; i < 200; ++i) {
        const double share = i / 199.0;
        even(i, dof) = bump(share);
        late(i, dof) = bump(share * share);
    }
    for (int i = 0; i <= 64; ++i) registration.push_back(std::sqrt(i / 64.0));
    const std::vector<Clip> clips = {clip_of(even), clip_of(late)};
    std::vector<MotionRun> runs = {{0, 0, 200, 0, 200}, {1, 0, 200, 200, 0}};
    const auto swing = [&] {
        const MatrixF angles = play_runs(clips, runs).motion.col(dof);
        return double(angles.maxCoeff() - angles.minCoeff());
    };
    CHECK(swing() < 0.9);
    runs[1].registration = registration;
    CHECK(swing() == Approx(1).margin(0.02));
    CHECK(play_runs(clips, runs).frames() == std::llround(std::ceil(frames_of_runs(runs) - 1e-6)));

    for (const std::vector<double>& bad : {std::vector{0.0}, {0.0, 0.5}, {0.0, 0.6, 0.5, 1.0}}) {
        runs[1].registration = bad;
        CHECK_THROWS_AS(play_runs(clips, runs), std::invalid_argument);
    }
}

TEST_CASE("what cannot be joined is refused") {
    const Clip clip = clip_of(wandering(50));
    Clip other_rate = clip, other_body = clip;
    other_rate.rate = 60;
    other_body.skeleton = std::make_shared<const Skeleton>(skeleton());
    const auto play = [&](const Clip& second, std::vector<MotionRun> runs) {
        play_runs(std::vector{clip, second}, runs);
    };
    CHECK_NOTHROW(play(clip, {whole(0, 50), whole(1, 50)}));
    CHECK_THROWS_AS(play(clip, {}), std::invalid_argument);
    CHECK_THROWS_AS(play(clip, {whole(2, 50)}), std::invalid_argument);
    CHECK_THROWS_AS(play(other_rate, {whole(0, 50), whole(1, 50)}), std::invalid_argument);
    CHECK_THROWS_AS(play(other_body, {whole(0, 50), whole(1, 50)}), std::invalid_argument);
    CHECK_THROWS_AS(play(clip, {{0, 0, 10, 0, 20}, {1, 0, 50, 20, 0}}), std::invalid_argument);
    CHECK_THROWS_AS(play(clip, {{0, 0, 10, 5, 0}}), std::invalid_argument);
    CHECK_THROWS_AS(play(clip, {{0, 0, 20, 0, 10}, {1, 0, 50, 10, 0, 9}}), std::invalid_argument);
    CHECK_NOTHROW(play(clip, {{0, 0, 20, 0, 10}, {1, 0, 50, 10, 0, 11}}));
    CHECK_THROWS_AS(blend_motions(std::vector<BlendPart>{}), std::invalid_argument);
    CHECK_THROWS_AS(blend_motions(std::vector<BlendPart>{{&clip, 0, 50, 0}}),
                    std::invalid_argument);
    CHECK_THROWS_AS(blend_motions(std::vector<BlendPart>{{&clip, 0, 50, 2}, {&clip, 0, 50, -1}}),
                    std::invalid_argument);

    using enum Channel;
    const auto bound = std::make_shared<const Skeleton>(skeleton({tx, ty, tz, rx, ry}));
    CHECK_THROWS_WITH(MotionBlend(bound, 120), Catch::Contains("small body"));
}
