#include "kinetome/features/effectors.h"

#include <catch2/catch.hpp>

#include "small_body.h"

using namespace kinetome;
using small_body::positions_of;

TEST_CASE("end effectors come in their order, as the root sees them") {
    const Skeleton body = small_body::skeleton();
    MatrixF motion = MatrixF::Zero(1, body.dof_count());
    motion.row(0).head(6) << 300, 90, -200, 0.4F, -0.3F, 2.0F;
    const MatrixF effectors = effector_positions(body, motion, positions_of(body, motion));
    REQUIRE(effectors.cols() == 15);
    const float expected[] = {0,  70,  5,                // head
                              60, 45,  0, -60, 45,  0,   // wrists
                              9,  -85, 2, -9,  -85, 2};  // ankles
    for (int c = 0; c < 15; ++c) CHECK(effectors(0, c) == Approx(expected[c]).margin(1e-3));
}

TEST_CASE("end effectors do not depend on how the root stands") {
    const Skeleton body = small_body::skeleton();
    const MatrixF motion = small_body::wandering(200);
    MatrixF upright = motion;
    upright.leftCols(6).setZero();
    const MatrixF effectors = effector_positions(body, motion, positions_of(body, motion));
    const MatrixF expected = effector_positions(body, upright, positions_of(body, upright));
    CHECK((effectors - expected).cwiseAbs().maxCoeff() < 1e-3F);
}

TEST_CASE("a skeleton without a wrist is refused, naming the wrist") {
    Skeleton body = small_body::skeleton();
    body.set_role(JointRole::right_wrist, -1);
    const MatrixF motion = small_body::wandering(2);
    CHECK_THROWS_WITH(effector_positions(body, motion, positions_of(body, motion)),
                      Catch::Contains("right_wrist"));
}

TEST_CASE("positions of other frames or another skeleton are refused") {
    const Skeleton body = small_body::skeleton();
    const MatrixF motion = small_body::wandering(4);
    const MatrixF positions = positions_of(body, motion);
    CHECK_THROWS_AS(effector_positions(body, motion, positions.topRows(3)), std::invalid_argument);
    CHECK_THROWS_AS(effector_positions(body, motion, positions.leftCols(21)),
                    std::invalid_argument);
}

TEST_CASE("a row is stacked between its neighbours, the clip's ends repeated") {
    MatrixF rows(5, 2);
    for (int i = 0; i < 5; ++i) rows.row(i) << static_cast<float>(i), static_cast<float>(10 * i);
    const int64_t offset = GENERATE(0, 1, 2, 7);
    const MatrixF stacked = stack_neighbours(rows, offset);
    REQUIRE(stacked.rows() == 5);
    REQUIRE(stacked.cols() == 6);
    for (int64_t i = 0; i < 5; ++i) {
        CHECK(stacked.row(i).segment(0, 2) == rows.row(std::max<int64_t>(i - offset, 0)));
        CHECK(stacked.row(i).segment(2, 2) == rows.row(i));
        CHECK(stacked.row(i).segment(4, 2) == rows.row(std::min<int64_t>(i + offset, 4)));
    }
    CHECK_THROWS_AS(stack_neighbours(rows, -1), std::invalid_argument);
}

TEST_CASE("an empty clip has no effector rows") {
    const Skeleton body = small_body::skeleton();
    const MatrixF motion = small_body::wandering(0);
    const MatrixF effectors = effector_positions(body, motion, MatrixF(0, 24));
    CHECK(effectors.rows() == 0);
    const MatrixF stacked = stack_neighbours(effectors);
    CHECK(stacked.rows() == 0);
    CHECK(stacked.cols() == 45);
}

TEST_CASE("chosen effectors are the columns of theirs, in the order of all") {
    MatrixF all(2, 15);
    for (int64_t i = 0; i < all.size(); ++i) all.data()[i] = float(i);
    const std::array arms = {JointRole::right_wrist, JointRole::left_wrist};
    const MatrixF chosen = select_effectors(all, arms);
    CHECK(chosen == all.middleCols(3, 6));
    CHECK(select_effectors(all, effector_roles) == all);
    const std::array head = {JointRole::head};
    CHECK(select_effectors(all, head) == all.leftCols(3));
    const std::array elbow = {JointRole::left_elbow};
    const std::array twice = {JointRole::head, JointRole::head};
    CHECK_THROWS_AS(select_effectors(all, elbow), std::invalid_argument);
    CHECK_THROWS_AS(select_effectors(all, twice), std::invalid_argument);
    CHECK_THROWS_AS(select_effectors(all, {}), std::invalid_argument);
    CHECK_THROWS_AS(select_effectors(all.leftCols(12), head), std::invalid_argument);
}

TEST_CASE("the radius for some effectors leaves each of them as far as that for all") {
    const MatrixF one_apart = MatrixF::Constant(1, 15, 1);
    const std::array arms = {JointRole::left_wrist, JointRole::right_wrist};
    const double all = double(one_apart.norm());
    CHECK(radius_for_effectors(all, 2) == Approx(double(select_effectors(one_apart, arms).norm())));
    CHECK(radius_for_effectors(72, 5) == 72);
}
