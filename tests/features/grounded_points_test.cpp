#include "kinetome/features/grounded_points.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "kinetome/features/effectors.h"
#include "small_body.h"

using namespace kinetome;
using small_body::positions_of;

namespace {

constexpr int points = 6, now = 3 * points;  // columns of a frame; the first one of the middle one

}  // namespace

TEST_CASE("grounded points stand on the floor below the root") {
    const Skeleton body = small_body::skeleton();
    MatrixF motion = MatrixF::Zero(1, body.dof_count());
    motion.row(0).head(3) << 300, 90, -200;
    const MatrixF grounded =
        grounded_points(body, motion, positions_of(body, motion), effector_roles, 3);
    REQUIRE(grounded.cols() == 3 * now);
    const float expected[] = {0,  90,  0,                // root
                              0,  160, 5,                // head
                              60, 135, 0, -60, 135, 0,   // wrists
                              9,  5,   2, -9,  5,   2};  // ankles
    for (int c = 0; c < now; ++c) {
        CHECK(grounded(0, now + c) == Approx(expected[c]).margin(1e-3));
        CHECK(grounded(0, c) == grounded(0, now + c));
    }
}

TEST_CASE("grounded points forget where a body stands and faces, but not that it travels") {
    const Skeleton body = small_body::skeleton();
    MatrixF motion = MatrixF::Zero(3, body.dof_count());
    for (int frame = 0; frame < 3; ++frame) motion.row(frame).head(3) << 0, 90, 10.0F * frame;
    const MatrixF ahead =
        grounded_points(body, motion, positions_of(body, motion), effector_roles, 1);
    CHECK(ahead(1, 2) == Approx(-10).margin(1e-3));
    CHECK(ahead(1, now + 2) == Approx(0).margin(1e-3));
    CHECK(ahead(1, 2 * now + 2) == Approx(10).margin(1e-3));

    MatrixF elsewhere = motion;
    const float turn = 2;
    for (int frame = 0; frame < 3; ++frame) {
        const float way = 10.0F * static_cast<float>(frame);
        elsewhere.row(frame).head(3) << 500 + way * std::sin(turn), 90, -70 + way * std::cos(turn);
        elsewhere(frame, small_body::root_yaw) = turn;
    }
    const MatrixF there =
        grounded_points(body, elsewhere, positions_of(body, elsewhere), effector_roles, 1);
    CHECK((there - ahead).cwiseAbs().maxCoeff() < 1e-3F);
}

TEST_CASE("grounded points cannot be taken at a negative offset") {
    const Skeleton body = small_body::skeleton();
    const MatrixF motion = small_body::wandering(2);
    CHECK_THROWS_AS(grounded_points(body, motion, positions_of(body, motion), effector_roles, -1),
                    std::invalid_argument);
}
