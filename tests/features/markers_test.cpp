#include "kinetome/features/markers.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <numbers>

#include "small_body.h"

using namespace kinetome;
using small_body::positions_of;

namespace {

constexpr int left_hip = 1, right_hip = 3, head = 5;

MatrixF markers_of(const MatrixF& motion) {
    const Skeleton body = small_body::skeleton();
    return normalised_markers(body, motion, positions_of(body, motion));
}

Eigen::RowVector3f marker(const MatrixF& markers, Eigen::Index frame, int joint) {
    return markers.block<1, 3>(frame, 3 * joint);
}

}  // namespace

TEST_CASE("markers are named after the joints") {
    const auto names = marker_names(small_body::skeleton());
    REQUIRE(names.size() == 8);
    CHECK(names.front() == "root");
    CHECK(names.back() == "rwrist");
}

TEST_CASE("the root is the origin and the hip axis points along +x") {
    const MatrixF markers = markers_of(small_body::wandering(200));
    for (Eigen::Index i = 0; i < 200; ++i) {
        CHECK(marker(markers, i, 0).isZero());
        const Eigen::RowVector3f axis =
            marker(markers, i, right_hip) - marker(markers, i, left_hip);
        CHECK(axis.x() > 0);
        CHECK(axis.z() == Approx(0).margin(1e-4));
    }
}

TEST_CASE("normalising turns the body about the vertical only") {
    const MatrixF motion = small_body::wandering(100);
    const MatrixF positions = positions_of(small_body::skeleton(), motion);
    const MatrixF markers = markers_of(motion);
    for (Eigen::Index i = 0; i < 100; ++i) {
        for (int joint = 1; joint < 8; ++joint) {
            const Eigen::RowVector3f before = marker(positions, i, joint) - marker(positions, i, 0);
            CHECK(marker(markers, i, joint).y() == Approx(before.y()).margin(1e-3));
            CHECK(marker(markers, i, joint).norm() == Approx(before.norm()).epsilon(1e-5));
        }
        // A mirror image would keep lengths and heights too.
        const auto handedness = [i](const MatrixF& p) {
            const Eigen::RowVector3f root = marker(p, i, 0);
            return (marker(p, i, 6) - root)
                .cross(marker(p, i, 7) - root)
                .dot(marker(p, i, 2) - root);
        };
        CHECK(handedness(markers) == Approx(handedness(positions)).epsilon(1e-3));
    }
}

TEST_CASE("markers forget where the body is and which way it faces") {
    const MatrixF motion = small_body::wandering(300);
    const MatrixF markers = markers_of(motion);
    for (const double angle : {0.9, std::numbers::pi, -2.2}) {
        const MatrixF elsewhere = small_body::turned_and_moved(motion, angle, -210, 95);
        CHECK((markers - markers_of(elsewhere)).cwiseAbs().maxCoeff() < 2e-3F);
    }
}

TEST_CASE("while the hip axis is vertical a frame keeps the heading of the frame before") {
    const Skeleton body = small_body::skeleton();
    const MatrixF motion = MatrixF::Zero(3, body.dof_count());
    MatrixF positions = MatrixF::Zero(3, 24);
    for (int i = 0; i < 3; ++i) positions.block<1, 3>(i, 3 * head) << 7, 60, 3;
    positions.block<1, 3>(0, 3 * right_hip) << 0, 0, 18;
    positions.block<1, 3>(1, 3 * right_hip) << 0, 18, 0;
    positions.block<1, 3>(2, 3 * right_hip) << 1e-4F, -18, -1e-4F;

    const MatrixF markers = normalised_markers(body, motion, positions);
    for (int i = 0; i < 3; ++i) {
        CAPTURE(i);
        CHECK(marker(markers, i, head).isApprox(Eigen::RowVector3f(3, 60, -7)));
    }
}

TEST_CASE("a clip that begins with a vertical hip axis takes its heading from the root") {
    const Skeleton body = small_body::skeleton();
    const double yaw = GENERATE(0.0, 0.8, -2.0);
    MatrixF motion = MatrixF::Zero(1, body.dof_count());
    motion(0, small_body::root_yaw) = static_cast<float>(yaw);
    MatrixF positions = MatrixF::Zero(1, 24);
    positions.block<1, 3>(0, 3 * right_hip) << 0, 18, 0;
    positions.block<1, 3>(0, 3 * head) << static_cast<float>(50 * std::sin(yaw)), 20,
        static_cast<float>(50 * std::cos(yaw));  // ahead of the root

    // With the right along +x and up along +y, ahead is -z.
    const MatrixF markers = normalised_markers(body, motion, positions);
    CHECK((marker(markers, 0, head) - Eigen::RowVector3f(0, 20, -50)).norm() < 1e-4F);
}

TEST_CASE("a skeleton without hips is refused, naming the hip, an empty clip has no markers") {
    Skeleton body = small_body::skeleton();
    CHECK(normalised_markers(body, small_body::wandering(0), MatrixF(0, 24)).rows() == 0);
    body.set_role(JointRole::left_hip, -1);
    const MatrixF motion = small_body::wandering(2);
    CHECK_THROWS_WITH(normalised_markers(body, motion, positions_of(body, motion)),
                      Catch::Contains("left_hip"));
}
