#include "kinetome/models/motion_quality.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "features/small_body.h"

using namespace kinetome;

namespace {

constexpr double rate = 100;
constexpr int left = 2, right = 4;  // ankles of the small body

/// All joints at one place but the left ankle: it stands for 100 frames, slides by 0.1 cm a frame
/// for 50, swings for 50 and stands again for 50.
MatrixF steps() {
    MatrixF positions = MatrixF::Zero(250, 3 * small_body::skeleton().joint_count());
    for (int i = 0; i < 250; ++i) {
        positions(i, 3 * right) = float(i);  // never stands: 100 cm/s
        positions(i, 3 * left) = float(0.1 * std::clamp(i - 99, 0, 50));
        if (i >= 150 && i < 200) {
            positions(i, 3 * left + 1) = float(10 * std::sin((i - 150) * 3.14159 / 50));
            positions(i, 3 * left + 2) = float(i - 150);
        }
        if (i >= 200) positions(i, 3 * left + 2) = 50;
    }
    return positions;
}

}  // namespace

TEST_CASE("a foot stands while it is low and slow, not while it swings or hangs in the air") {
    const auto contacts = foot_contacts(small_body::skeleton(), steps(), rate);
    REQUIRE(contacts.size() == 250);
    for (size_t i = 0; i < 250; ++i) {
        if (i > 145 && i < 205) continue;
        CHECK(contacts[i][0]);
    }
    for (size_t i = 152; i < 198; ++i) CHECK_FALSE(contacts[i][0]);
    for (size_t i = 0; i < 250; ++i) {
        CHECK_FALSE(contacts[i][1]);
        CHECK_FALSE(contacts[i][2]);  // the body has no toes
    }
}

TEST_CASE("a floor that few noisy frames lie below is where the foot stands all the same") {
    MatrixF positions = steps();
    positions.col(3 * left + 1).array() += 30;
    positions(10, 3 * left + 1) = -20;
    const auto contacts = foot_contacts(small_body::skeleton(), positions, rate);
    CHECK(contacts[60][0]);
    CHECK_FALSE(contacts[9][0]);  // it comes to the noisy frame too fast
}

TEST_CASE("slide is what a standing foot goes along the floor, by the seconds it stands") {
    const auto body = small_body::skeleton();
    std::vector<FootContacts> contacts(250, FootContacts{});
    for (size_t i = 0; i < 150; ++i) contacts[i][0] = true;
    const FootSlide slide = foot_slide(body, steps(), contacts, rate);
    CHECK(slide.distance == Approx(5).epsilon(1e-4));
    CHECK(slide.seconds == Approx(1.49));
    CHECK(slide.speed() == Approx(5 / 1.49).epsilon(1e-4));
    CHECK(foot_slide(body, steps(), std::vector<FootContacts>(250), rate).speed() == 0);
    CHECK_THROWS_AS(foot_slide(body, steps(), std::vector<FootContacts>(249), rate),
                    std::invalid_argument);
}

TEST_CASE("a jump of one joint is the greatest speed and acceleration of all") {
    MatrixF positions = MatrixF::Zero(20, 12);
    for (int i = 0; i < 20; ++i) positions(i, 3) = float(i);  // 100 cm/s throughout
    CHECK(joint_peaks(positions, rate).speed == Approx(100));
    CHECK(joint_peaks(positions, rate).acceleration == Approx(0).margin(1e-9));
    positions.bottomRows(10).col(7).setConstant(3);  // 3 cm from one frame to the next
    CHECK(joint_peaks(positions, rate).speed == Approx(300));
    CHECK(joint_peaks(positions, rate).acceleration == Approx(30000));
    CHECK(joint_peaks(positions.topRows(1), rate).speed == 0);
}

TEST_CASE("a walk is measured beside the runs it is made of, its feet by where they stood there") {
    using namespace small_body;
    const auto body = std::make_shared<const Skeleton>(skeleton());
    // A body that stands, and one that glides at 24 cm/s: slow enough to stand for the measure.
    MatrixF still = MatrixF::Zero(200, skeleton().dof_count()), glide = still;
    glide.col(root_z) = VectorF::LinSpaced(200, 0, 0.2f * 199);
    const std::vector<Clip> clips = {{body, still, 120.0}, {body, glide, 120.0}};
    const std::vector<MotionRun> runs = {{0, 0, 100, 0, 40}, {1, 60, 200, 40, 0}};
    const Clip walk = play_runs(clips, runs);
    REQUIRE(walk.frames() == 200);
    const WalkQuality quality = measure_walk(clips, runs, walk);
    // Both ankles stand all the time. In the takes 139 of 238 steps glide, in the walk 100 of 199
    // and half of those in the fade, 120 in all.
    CHECK(quality.slide_in_takes.speed() == Approx(24 * 139.0 / 238));
    CHECK(quality.slide.seconds == Approx(2 * 199 / 120.0));
    CHECK(quality.slide.speed() == Approx(24 * 120.0 / 199).epsilon(0.01));
    CHECK(quality.peaks.speed == Approx(24).epsilon(1e-3));
    CHECK(quality.peaks_in_takes.speed == Approx(24).epsilon(1e-3));
    const auto sources = sources_of_runs(runs);
    REQUIRE(sources.size() == 200);
    CHECK(sources[79].clip == 0);
    CHECK(sources[79].frame == 79);
    CHECK(sources[81].clip == 1);
    CHECK(sources[81].frame == 81);
}

TEST_CASE("a pose step is what joints move beside the root and its heading") {
    using namespace small_body;
    const auto body = std::make_shared<const Skeleton>(skeleton());
    MatrixF motion = MatrixF::Zero(50, skeleton().dof_count());
    for (int i = 0; i < 50; ++i) motion(i, root_z) = 3 * float(i);
    motion.col(root_yaw) = VectorF::LinSpaced(50, 0, 2);
    const Clip still{body, motion, rate};
    CHECK(largest_step(pose_steps(still), {.first = 0, .end = 50}) < 0.1);
    motion.bottomRows(20).col(root_pitch).setConstant(0.2f);  // all joints tilt about the root
    const auto steps = pose_steps({body, motion, rate});
    REQUIRE(steps.size() == 49);
    double squares = 0;
    for (const Joint& joint : body->joints()) {
        if (joint.parent < 0) continue;
        Eigen::Vector3d at = joint.offset_after;
        if (joint.parent > 0) at += body->joints()[size_t(joint.parent)].offset_after;
        squares += std::pow(2 * std::sin(0.1) * std::hypot(at.y(), at.z()), 2);
    }
    const double expected = std::sqrt(squares / double(body->joint_count())) * rate;
    CHECK(steps[29] == Approx(expected).epsilon(1e-3));
    CHECK(largest_step(steps, {.first = 0, .end = 50}) == steps[29]);
    CHECK(largest_step(steps, {.first = 0, .end = 30}) < 0.1);
    CHECK(largest_step(steps, {.first = 40, .end = 500}) < 0.1);
}

TEST_CASE("how firmly a foot stands rises and falls over the time given") {
    std::vector<FootContacts> contacts(100, FootContacts{});
    for (size_t i = 40; i < 60; ++i) contacts[i][1] = true;
    const auto support = foot_support(contacts, 120, 0.1);
    REQUIRE(support.size() == 100);
    for (size_t i = 1; i < 100; ++i) {
        CHECK(support[i][0] == 0);
        CHECK(std::abs(support[i][1] - support[i - 1][1]) < 0.08);
    }
    CHECK(support[33][1] == 0);
    CHECK(support[50][1] == 1);
    CHECK(support[66][1] == 0);
}
