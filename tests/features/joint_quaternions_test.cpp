#include "kinetome/features/joint_quaternions.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "small_body.h"

using namespace kinetome;

TEST_CASE("the joints on the ways to head, hands and feet are taken, the root is not") {
    const Skeleton body = small_body::skeleton();
    std::set<std::string> names;
    for (const int joint : limb_joints(body)) names.insert(body.joints()[size_t(joint)].name);
    INFO(names.size());
    CHECK(names.count("root") == 0);
    for (const JointRole role : {JointRole::left_wrist, JointRole::right_ankle, JointRole::head}) {
        int joint = body.role(role);
        while (joint > 0 && body.joints()[size_t(joint)].channels.empty()) {
            joint = body.joints()[size_t(joint)].parent;
        }
        if (joint > 0) CHECK(names.count(body.joints()[size_t(joint)].name) == 1);
    }
}

TEST_CASE("quaternions are of unit length, and turn on without jumping to their opposites") {
    const Skeleton body = small_body::skeleton();
    const std::vector<int> limbs = limb_joints(body);
    REQUIRE(!limbs.empty());
    MatrixF motion = MatrixF::Zero(300, body.dof_count());
    const int column = body.first_dof(limbs.front());
    for (int64_t i = 0; i < motion.rows(); ++i) {
        motion(i, column) = float(double(i) * 4 * std::numbers::pi / 300);  // two whole turns
    }
    const MatrixF quaternions = joint_quaternions(body, motion);
    REQUIRE(quaternions.cols() == static_cast<Eigen::Index>(4 * limbs.size()));
    for (int64_t i = 0; i < motion.rows(); ++i) {
        CHECK(quaternions.block(i, 0, 1, 4).norm() == Approx(1).margin(1e-5));
        CHECK(quaternions(i, 0) == Approx(std::cos(double(motion(i, column)) / 2)).margin(1e-5));
    }
}
