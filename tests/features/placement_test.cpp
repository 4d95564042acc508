#include "kinetome/features/placement.h"

#include <catch2/catch.hpp>
#include <numbers>

#include "kinetome/formats/euler.h"
#include "small_body.h"

using namespace kinetome;

namespace {

constexpr double right_angle = std::numbers::pi / 2;

std::vector<float> frame_of(const MatrixF& motion, int64_t frame) {
    return {motion.row(frame).data(), motion.row(frame).data() + motion.cols()};
}

}  // namespace

TEST_CASE("a step as seen from the one who makes it leads from one placement to the other") {
    const Placement from{.x = 10, .z = -20, .heading = 3.0};
    const Placement to{.x = -5, .z = 7, .heading = -3.1};
    const Placement step = step_between(from, to);
    CHECK(step.heading == Approx(2 * std::numbers::pi - 6.1));
    const Placement reached = after_step(from, step);
    CHECK(reached.x == Approx(to.x));
    CHECK(reached.z == Approx(to.z));
    CHECK(nearest_turn(reached.heading, to.heading) == Approx(to.heading));

    // Who faces +x (a quarter turn) and goes forward goes along +x.
    const Placement forward = after_step({.heading = right_angle}, {.z = 4});
    CHECK(forward.x == Approx(4));
    CHECK(forward.z == Approx(0).margin(1e-12));
}

TEST_CASE("turning and moving the floor turns and moves the placement, also of who lies down") {
    const Skeleton body = small_body::skeleton();
    const RootChain root(body);
    for (const double pitch : {0.0, 0.7, right_angle, -right_angle, 2.0}) {
        MatrixF motion = small_body::wandering(40);
        motion.col(small_body::root_pitch).setConstant(static_cast<float>(pitch));
        const MatrixF moved = small_body::turned_and_moved(motion, 1.1, 30, -12);
        for (int64_t frame = 0; frame < motion.rows(); ++frame) {
            const Placement before = placement_of(root.pose(frame_of(motion, frame)));
            const Placement after = placement_of(root.pose(frame_of(moved, frame)));
            CHECK(nearest_turn(after.heading - before.heading - 1.1, 0) == Approx(0).margin(1e-5));
            CHECK(after.x ==
                  Approx(std::cos(1.1) * before.x + std::sin(1.1) * before.z + 30).margin(1e-3));
            CHECK(after.z ==
                  Approx(std::cos(1.1) * before.z - std::sin(1.1) * before.x - 12).margin(1e-3));
        }
    }
}

TEST_CASE("a frame that is placed elsewhere is the same pose there, whatever the root's channels") {
    using enum Channel;
    const std::vector<std::vector<Channel>> channels = {
        small_body::turn_last, {tx, ty, tz, rx, ry, rz}, {rz, ty, ry, tx, rx, tz}};
    for (const auto& order : channels) {
        const Skeleton body = small_body::skeleton(order);
        const RootChain root(body);
        const MatrixF motion = small_body::wandering(60);
        for (int64_t frame = 0; frame < motion.rows(); ++frame) {
            std::vector<float> dofs = frame_of(motion, frame);
            const Placement before = placement_of(root.pose(dofs));
            const Placement goal{.x = 50, .z = -70, .heading = 2.5};
            place(root, dofs, goal, dofs);
            const Placement reached = placement_of(root.pose(dofs));
            CHECK(reached.x == Approx(goal.x));
            CHECK(reached.z == Approx(goal.z));
            CHECK(nearest_turn(reached.heading, 2.5) == Approx(2.5));

            const auto seen = [&](std::span<const float> one, const Placement& from, size_t joint) {
                const Eigen::Vector3d at = forward_kinematics(body, one).positions[joint];
                const Placement step =
                    step_between(from, {.x = at.x(), .z = at.z(), .heading = from.heading});
                return Eigen::Vector3d(step.x, at.y(), step.z);
            };
            for (size_t joint = 0; joint < 8; ++joint) {
                CHECK((seen(dofs, goal, joint) - seen(frame_of(motion, frame), before, joint))
                          .norm() < 1e-3);
            }
        }
    }
}

TEST_CASE("a root below a reference on the floor is placed by its own channels alone") {
    const Skeleton inner = small_body::skeleton();
    std::vector<Joint> joints = {
        small_body::bone("reference", -1, {0, 3, 0}, small_body::turn_last)};
    for (Joint joint : inner.joints()) {
        ++joint.parent;
        joints.push_back(joint);
    }
    Skeleton body("with a reference", joints);
    body.set_role(JointRole::root, 1);
    const RootChain root(body);
    std::vector<float> dofs(static_cast<size_t>(body.dof_count()), 0.3f);
    const RootPose goal{{5, 90, -4}, axis_rotation(1, 0.4) * axis_rotation(0, 0.2)};
    root.set_pose(dofs, goal, dofs);
    CHECK((root.pose(dofs).position - goal.position).norm() < 1e-4);
    CHECK((root.pose(dofs).rotation - goal.rotation).norm() < 1e-6);
    for (size_t i = 0; i < 6; ++i) CHECK(dofs[i] == 0);
}

TEST_CASE("a root that lacks a channel is not free, and setting its pose is refused by name") {
    using enum Channel;
    const Skeleton body = small_body::skeleton({tx, ty, tz, rx, ry});
    std::vector<float> dofs(static_cast<size_t>(body.dof_count()));
    CHECK_FALSE(RootChain(body).is_free());
    CHECK_THROWS_WITH(RootChain(body).set_pose(dofs, RootChain(body).pose(dofs), dofs),
                      Catch::Contains("'root'"));
}
