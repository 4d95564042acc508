#include "kinetome/synthesis/clip_variation.h"

#include <catch2/catch.hpp>
#include <map>
#include <stdexcept>

#include "kinetome/formats/asf_amc.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/formats/resample.h"
#include "kinetome/formats/write_amc.h"
#include "kinetome/synthesis/take.h"
#include "support/cmu_take.h"
#include "support/test_corpus.h"

using namespace kinetome;

namespace {

Clip performed(int64_t frames = 600) {
    return perform(plan_take(3, frames, 1, 1, 17), make_subject(1, 17), 17);
}

std::string partner(const std::string& name) {
    if (name == "lowerback" || name == "lowerneck" || name == "root") return name;
    if (name[0] == 'l') return "r" + name.substr(1);
    if (name[0] == 'r') return "l" + name.substr(1);
    return name;
}

/// Greatest distance in cm between the image's joints and the reflections of their partners.
double reflection_error(const Clip& clip, const Clip& image) {
    const MatrixF own = joint_positions(clip), seen = joint_positions(image);
    const Skeleton& skeleton = *clip.skeleton;
    double greatest = 0;
    for (int64_t frame = 0; frame < clip.frames(); frame += 7) {
        for (int j = 0; j < skeleton.joint_count(); ++j) {
            const int k = *skeleton.find(partner(skeleton.joints()[static_cast<size_t>(j)].name));
            const Eigen::Vector3f expected(-own(frame, 3 * k), own(frame, 3 * k + 1),
                                           own(frame, 3 * k + 2));
            const Eigen::Vector3f found = seen.row(frame).segment<3>(3 * j).transpose();
            greatest = std::max(greatest, static_cast<double>((found - expected).norm()));
        }
    }
    return greatest;
}

}  // namespace

TEST_CASE("every joint of a mirrored take is the reflection of its partner") {
    const Clip clip = performed();
    CHECK(reflection_error(clip, mirrored(clip)) < 1e-2);
    CHECK(reflection_error(clip, clip) > 5);  // the take itself is not symmetric
}

TEST_CASE("on a symmetric body the mirrored motion needs no new skeleton") {
    const Clip clip = performed();
    Clip image = mirrored(clip);
    image.skeleton = clip.skeleton;
    CHECK(reflection_error(clip, image) < 1e-2);
}

TEST_CASE("an uneven body is mirrored as exactly, also after a round trip through the files") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    const Clip clip = cmu_take(*corpus, "02_05");
    const Clip image = mirrored(clip);
    CHECK(image.skeleton->class_name() == clip.skeleton->class_name());
    CHECK(reflection_error(clip, image) < 1e-2);
    const auto skeleton =
        std::make_shared<const Skeleton>(parse_asf(write_asf(*image.skeleton), "image.asf"));
    CHECK(reflection_error(clip, parse_amc(write_amc(image), "image.amc", skeleton)) < 1e-2);
}

TEST_CASE("a take mirrored twice is the take again") {
    const Clip clip = performed();
    const Clip twice = mirrored(mirrored(clip));
    CHECK((twice.motion - clip.motion).cwiseAbs().maxCoeff() == 0);
}

TEST_CASE("sides that do not match cannot be mirrored") {
    std::vector<Joint> joints(3);
    joints[0].name = "root";
    joints[1].name = "lfemur";
    joints[2].name = "rfemur";
    joints[1].parent = joints[2].parent = 0;
    joints[1].channels = {Channel::rx};
    joints[2].channels = {Channel::rx, Channel::ry};
    CHECK_THROWS_AS(mirrored(Skeleton("uneven", joints)), std::invalid_argument);
    joints[2].channels = {Channel::rx};
    CHECK_NOTHROW(mirrored(Skeleton("even", joints)));
}

TEST_CASE("labels change sides with the body") {
    CHECK(mirrored_label("punch_left") == "punch_right");
    CHECK(mirrored_label("kick_right") == "kick_left");
    CHECK(mirrored_label("Left hook") == "Right hook");
    CHECK(mirrored_label("walk") == "walk");
    CHECK(mirrored_label("roll") == "roll");
}

TEST_CASE("a scaled take moves every joint to the scaled place") {
    const Clip clip = performed(200);
    const MatrixF own = joint_positions(clip), larger = joint_positions(scaled(clip, 1.25));
    CHECK((larger - 1.25F * own).cwiseAbs().maxCoeff() < 1e-2F);
}

TEST_CASE("a time warp runs forwards through the whole source within its speeds") {
    for (uint64_t seed = 0; seed < 20; ++seed) {
        RandomStream random(seed, "warp test");
        const TimeWarp warp(2000, random);
        const std::vector<double>& at = warp.source_frames();
        REQUIRE(at.front() == 0);
        CHECK(at.back() <= 1999);
        CHECK(at.back() > 1999 - 1.4);
        double slowest = 9, fastest = 0;
        for (size_t i = 1; i < at.size(); ++i) {
            slowest = std::min(slowest, at[i] - at[i - 1]);
            fastest = std::max(fastest, at[i] - at[i - 1]);
        }
        CHECK(slowest >= 0.7 - 1e-9);
        CHECK(fastest <= 1.4 + 1e-9);
        CHECK(fastest - slowest > 0.05);
    }
}

TEST_CASE("frame ranges that tile the source tile the warped take") {
    RandomStream random(1, "warp test");
    const TimeWarp warp(1000, random);
    CHECK(warp.frame_at(0) == 0);
    CHECK(warp.frame_at(1000) == warp.frames());
    for (const int64_t boundary : {100, 101, 500, 999}) {
        const int64_t frame = warp.frame_at(boundary);
        if (frame < warp.frames()) {  // a boundary near the end may lie behind the last frame
            CHECK(warp.source_frames()[static_cast<size_t>(frame)] >=
                  static_cast<double>(boundary));
        }
        CHECK(warp.source_frames()[static_cast<size_t>(frame - 1)] < static_cast<double>(boundary));
    }
}

TEST_CASE("a source of one frame stays one frame") {
    RandomStream random(1, "warp test");
    CHECK(TimeWarp(1, random).frames() == 1);
}
