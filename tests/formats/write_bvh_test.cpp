#include "kinetome/formats/write_bvh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>
#include <string>

#include "kinetome/formats/kinematics.h"
#include "real_takes.h"
#include "reference_motion.h"
#include "small_rig.h"
#include "support/test_corpus.h"

using namespace kinetome;

namespace {

struct Difference {
    double cm = 0;
    double degrees = 0;
};

bool is_leaf(const Skeleton& skeleton, int joint) {
    return std::ranges::none_of(skeleton.joints(),
                                [&](const Joint& other) { return other.parent == joint; });
}

/// What the written BVH says, against the clip's own kinematics: each joint's beginning, each
/// leaf's end, each joint's rotation.
Difference greatest_difference(const Clip& clip) {
    const std::vector<reference::Placing> frames = reference::bvh_frames(write_bvh(clip));
    REQUIRE(static_cast<int64_t>(frames.size()) == clip.frames());
    Difference greatest;
    for (int64_t row = 0; row < clip.frames(); ++row) {
        const Pose pose = forward_kinematics(
            *clip.skeleton, {clip.motion.row(row).data(), static_cast<size_t>(clip.motion.cols())});
        const reference::Placing& frame = frames[static_cast<size_t>(row)];
        const auto compare = [&](const Eigen::Vector3d& expected, const std::string& name) {
            const reference::Vector found = frame.at(name).end;
            const double cm = (expected - Eigen::Vector3d(found.x, found.y, found.z)).norm();
            greatest.cm = std::max(greatest.cm, cm);
        };
        for (int j = 0; j < clip.skeleton->joint_count(); ++j) {
            const Joint& joint = clip.skeleton->joints()[static_cast<size_t>(j)];
            const Eigen::Vector3d& end = pose.positions[static_cast<size_t>(j)];
            const Eigen::Matrix3d& rotation = pose.rotations[static_cast<size_t>(j)];
            compare(end - rotation * joint.offset_after, joint.name);
            if (is_leaf(*clip.skeleton, j)) compare(end, joint.name + " end");
            const Eigen::Quaterniond q(rotation);
            greatest.degrees = std::max(greatest.degrees,
                                        reference::degrees_between({q.w(), q.x(), q.y(), q.z()},
                                                                   frame.at(joint.name).rotation));
        }
    }
    return greatest;
}

void check_same_motion(const Clip& clip) {
    const Difference greatest = greatest_difference(clip);
    CHECK(greatest.cm < 1e-3);
    CHECK(greatest.degrees < 1e-3);
}

}  // namespace

TEST_CASE("a written BVH holds the positions and rotations of an ASF rig with its axes") {
    check_same_motion(small_motion(150));
}

TEST_CASE("written BVH of real takes holds the same motion") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    for (const RealTake& take : real_takes(*corpus)) {
        INFO(take.amc_path);
        Clip clip = take.clip();
        const int64_t kept = std::min<int64_t>(clip.frames(), 120);
        clip.motion = clip.motion.topRows(kept).eval();
        check_same_motion(clip);
    }
}

TEST_CASE("a joint that passes through gimbal lock keeps its rotation and its angles do not jump") {
    Clip clip = small_motion(181);
    clip.motion.setZero();
    for (int64_t row = 0; row < clip.frames(); ++row) {
        clip.motion(row, 3) = 0.5F;
        clip.motion(row, 4) = static_cast<float>(row) * 0.017453292F;  // 90 degrees at row 90
        clip.motion(row, 5) = -0.3F;
    }
    check_same_motion(clip);

    std::istringstream lines(write_bvh(clip));
    std::string line;
    while (std::getline(lines, line) && !line.starts_with("Frame Time")) continue;
    double last_z = 0;
    for (int row = 0; std::getline(lines, line); ++row) {
        std::istringstream words(line);
        double x = 0, y = 0, z = 0, angle_z = 0;
        words >> x >> y >> z >> angle_z;
        if (row > 0) CHECK(std::abs(angle_z - last_z) < 5);
        last_z = angle_z;
    }
}

TEST_CASE("a rig whose joints move in their parents, as BVH rigs do, is written with its offsets") {
    Joint hips{
        .name = "Hips",
        .channels = {Channel::tx, Channel::ty, Channel::tz, Channel::rz, Channel::rx, Channel::ry},
        .limits = {}};
    hips.offset_before = {0, 90, 0};
    hips.first_rotation_acts_first = false;
    Joint knee = hips;
    knee.name = "Knee";
    knee.parent = 0;
    knee.offset_before = {0, -40, 1};
    Clip clip{std::make_shared<const Skeleton>("rig", std::vector<Joint>{hips, knee}), {}, 60, {}};
    clip.motion.resize(20, 12);
    for (int64_t row = 0; row < 20; ++row) {
        for (int64_t dof = 0; dof < 12; ++dof) {
            clip.motion(row, dof) =
                std::sin(0.3F * static_cast<float>(row) + static_cast<float>(dof));
        }
    }
    check_same_motion(clip);
}

TEST_CASE("frames written one by one are the whole take, to the byte") {
    const Clip clip = small_motion(7);
    std::string text;
    BvhWriter writer(clip.skeleton);
    writer.append_header(text, clip.frames(), clip.rate);
    for (int64_t row = 0; row < clip.frames(); ++row) {
        writer.append_frame(text, {clip.motion.row(row).data(), 15});
    }
    CHECK(text == write_bvh(clip));
}
