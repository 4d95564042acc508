#include "kinetome/formats/kinematics.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "kinetome/formats/euler.h"
#include "kinetome/formats/joint_roles.h"
#include "real_takes.h"
#include "reference_motion.h"
#include "replaced.h"
#include "small_rig.h"
#include "support/test_corpus.h"

using namespace kinetome;

namespace {

/// The small rig in the shape the reference reads.
std::string plain_asf() {
    return replaced(small_asf, "axis 10 -20 30 ZXY", "axis 10 -20 30 XYZ");
}

/// Greatest distance in cm between the two computations, over every `step`-th frame.
double greatest_difference(const Clip& clip, const std::string& asf, const std::string& amc,
                           int64_t step) {
    const reference::Asf truth(asf);
    const std::vector<reference::Frame> frames = reference::amc_frames(amc);
    const MatrixF positions = joint_positions(clip);
    double greatest = 0;
    for (int64_t row = 0; row < clip.frames(); row += step) {
        const reference::Placing placing = truth.place(frames[static_cast<size_t>(row)]);
        REQUIRE(placing.size() == clip.skeleton->joints().size());
        for (int j = 0; j < clip.skeleton->joint_count(); ++j) {
            const std::string& name = clip.skeleton->joints()[static_cast<size_t>(j)].name;
            const reference::Vector found{positions(row, 3 * j), positions(row, 3 * j + 1),
                                          positions(row, 3 * j + 2)};
            greatest = std::max(greatest, reference::distance(found, placing.at(name).end));
        }
    }
    return greatest;
}

bool has_dof(const Skeleton& skeleton, int joint, int dof) {
    const int first = skeleton.first_dof(joint);
    const auto& channels = skeleton.joints()[static_cast<size_t>(joint)].channels;
    return dof >= first && dof < first + static_cast<int>(channels.size());
}

}  // namespace

TEST_CASE("a generated take is posed as quaternions pose it") {
    const auto skeleton = std::make_shared<const Skeleton>(parse_asf(plain_asf(), "a"));
    std::string amc;
    for (int frame = 1; frame <= 40; ++frame) {
        const auto angle = [&](double size, double speed) {
            return " " + std::to_string(size * std::sin(speed * frame));
        };
        amc += std::to_string(frame) + "\nroot" + angle(30, 0.1) + angle(20, 0.2) + angle(9, 0.3) +
               angle(180, 0.1) + angle(180, 0.15) + angle(180, 0.21) + "\nthigh" + angle(90, 0.3) +
               angle(100, 0.11) + angle(170, 0.17) + "\nshin" + angle(120, 0.3) + "\nfoot" +
               angle(45, 0.5) + angle(60, 0.7) + "\nspine" + angle(80, 0.4) + angle(70, 0.33) +
               angle(60, 0.29) + "\n";
    }
    const Clip clip = parse_amc(amc, "a", skeleton);
    CHECK(greatest_difference(clip, plain_asf(), amc, 1) < 1e-3);
}

TEST_CASE("real takes are posed as quaternions pose them") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    const std::vector<RealTake> takes = real_takes(*corpus);
    CHECK(takes.size() == 18);
    for (const RealTake& take : takes) {
        INFO(take.amc_path);
        CHECK(greatest_difference(take.clip(), take.asf, take.amc, 25) < 1e-3);
    }
}

TEST_CASE("the head of 86_01 begins at 162 cm") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    const std::filesystem::path folder = *corpus / "cmu" / "86";
    const Clip clip = read_take(folder / "86.asf", folder / "86_01.amc").clip();
    Skeleton skeleton = *clip.skeleton;
    assign_roles(skeleton, "86.asf");
    const int head = skeleton.role(JointRole::head);
    CHECK(joint_positions(clip)(0, 3 * head + 1) == Approx(162.0).margin(1.0));
}

TEST_CASE("one frame alone is posed as in its clip, to the last bit") {
    const Clip clip = small_motion(3);
    const MatrixF positions = joint_positions(clip);
    const Pose pose = forward_kinematics(*clip.skeleton, {clip.motion.row(2).data(), 15});
    for (int j = 0; j < clip.skeleton->joint_count(); ++j) {
        const Eigen::Vector3f expected = pose.positions[static_cast<size_t>(j)].cast<float>();
        CHECK(positions.row(2).segment<3>(3 * j) == expected.transpose());
    }
}

TEST_CASE("a joint's rotation is its parent's rotation times its local one") {
    const Clip clip = small_motion(50);
    const std::span<const float> dofs(clip.motion.row(49).data(), 15);
    const Pose pose = forward_kinematics(*clip.skeleton, dofs);
    for (int j = 1; j < clip.skeleton->joint_count(); ++j) {
        const Joint& joint = clip.skeleton->joints()[static_cast<size_t>(j)];
        const auto first = static_cast<size_t>(clip.skeleton->first_dof(j));
        const Eigen::Matrix3d local =
            local_rotation(joint, dofs.subspan(first, joint.channels.size()));
        const Eigen::Matrix3d expected = pose.rotations[static_cast<size_t>(joint.parent)] * local;
        CHECK(pose.rotations[static_cast<size_t>(j)].isApprox(expected, 1e-12));
    }
}

TEST_CASE("a BVH joint's first rotation acts last and its offset comes before it") {
    Joint root{.name = "hips", .channels = {Channel::tx, Channel::rz, Channel::rx}};
    root.first_rotation_acts_first = false;
    Joint knee = root;
    knee.name = "knee";
    knee.parent = 0;
    knee.channels = {Channel::ty};
    knee.offset_before = {0, -10, 0};
    const Skeleton skeleton("rig", {root, knee});
    const double z = 0.3;
    const double x = 0.7;
    const std::vector<float> dofs = {5, static_cast<float>(z), static_cast<float>(x), 2};
    const Pose pose = forward_kinematics(skeleton, dofs);
    // Rz·Rx·(0, -8, 0)
    const Eigen::Vector3d expected(5 + 8 * std::cos(x) * std::sin(z),
                                   -8 * std::cos(x) * std::cos(z), -8 * std::sin(x));
    CHECK((pose.positions[1] - expected).norm() < 1e-5);
}

TEST_CASE("what degrees of freedom do to joints is what little changes of them do") {
    Joint bvh_root{.name = "hips",
                   .offset_before = {1, 2, 3},
                   .channels = {Channel::tx, Channel::rz, Channel::rx, Channel::ry},
                   .first_rotation_acts_first = false};
    Joint knee{.name = "knee",
               .parent = 0,
               .offset_before = {0, -10, 0},
               .channels = {Channel::ty, Channel::rx, Channel::tz, Channel::rz},
               .first_rotation_acts_first = false};
    const Joint foot{.name = "foot", .parent = 1, .offset_before = {0, -8, 3}};
    for (const Skeleton& skeleton : {Skeleton("rig", {bvh_root, knee, foot}), *small_skeleton()}) {
        const KinematicChain chain(skeleton);
        std::vector<float> dofs(static_cast<size_t>(skeleton.dof_count()));
        for (size_t i = 0; i < dofs.size(); ++i) dofs[i] = 0.25F * float(i % 7) - 0.5F;
        Pose pose, before, after;
        std::vector<DofMotion> motions(dofs.size());
        chain.evaluate(dofs, pose, motions);
        for (int dof = 0; dof < skeleton.dof_count(); ++dof) {
            constexpr float nudge = 1.0F / 256;  // a power of two: floats have it exactly
            const auto at = static_cast<size_t>(dof);
            const float kept = std::exchange(dofs[at], dofs[at] - nudge);
            chain.evaluate(dofs, before);
            dofs[at] = kept + nudge;
            chain.evaluate(dofs, after);
            dofs[at] = kept;
            for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
                const auto j = static_cast<size_t>(joint);
                int mover = joint;  // up to the joint that has this degree of freedom
                while (mover >= 0 && !has_dof(skeleton, mover, dof)) {
                    mover = skeleton.joints()[static_cast<size_t>(mover)].parent;
                }
                const Eigen::Vector3d moved =
                    mover < 0 ? Eigen::Vector3d::Zero().eval() : motions[at].at(pose.positions[j]);
                const Eigen::Vector3d expected =
                    (after.positions[j] - before.positions[j]) / (2 * double(nudge));
                INFO(skeleton.dof_names()[at] << " on joint " << joint);
                CHECK((moved - expected).norm() < 1e-3);
            }
        }
        motions.pop_back();
        CHECK_THROWS_AS(chain.evaluate(dofs, pose, motions), std::invalid_argument);
    }
}

TEST_CASE("a frame of another skeleton is refused") {
    const std::vector<float> dofs(14);
    CHECK_THROWS_AS(forward_kinematics(*small_skeleton(), dofs), std::invalid_argument);
}

TEST_CASE("a skeleton whose joints do not follow their parents is refused") {
    const Joint root{.name = "root"};
    const Joint early{.name = "early", .parent = 2};
    const Joint late{.name = "late", .parent = 0};
    CHECK_THROWS_AS(Skeleton("a", {root, early, late}), std::invalid_argument);
    CHECK_THROWS_AS(Skeleton("a", {root, late, late}), std::invalid_argument);
    CHECK_THROWS_AS(Skeleton("a", {late}), std::invalid_argument);
    CHECK_THROWS_AS(Skeleton("a", {root, root}), std::invalid_argument);
}
