#include "kinetome/models/pose_hierarchy.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace kinetome {
namespace {

/// Two markers, the first the origin; parted at x = 0, the right half again at y = 0. The marker
/// moves along z on the left, along x at the right.
PoseHierarchy three_leaves() {
    PoseHierarchy hierarchy;
    hierarchy.principal_columns = {3, 4};
    hierarchy.nodes = {{.below = 1, .above = 2, .offset = 0, .half_gap = 2},
                       {.parent = 0, .leaf = 0},
                       {.parent = 0, .below = 3, .above = 4, .offset = 0, .half_gap = 1},
                       {.parent = 2, .leaf = 1},
                       {.parent = 2, .leaf = 2}};
    hierarchy.normals = MatrixD::Zero(5, 2);
    hierarchy.normals(0, 0) = 1;
    hierarchy.normals(2, 1) = 1;
    hierarchy.means = MatrixD::Zero(3, 6);
    hierarchy.means.row(0) << 0, 0, 0, -2, 0, 0;
    hierarchy.means.row(1) << 0, 0, 0, 2, -1, 0;
    hierarchy.means.row(2) << 0, 0, 0, 2, 1, 0;
    hierarchy.bases = MatrixD::Zero(18, 1);
    hierarchy.bases(5, 0) = 1;
    hierarchy.bases(9, 0) = 1;
    hierarchy.bases(15, 0) = 1;
    hierarchy.leaf_errors = VectorD::Zero(3);
    return hierarchy;
}

VectorD at(double x, double y) {
    return Eigen::Vector2d(x, y);
}

TEST_CASE("a pose falls in the leaf on its side of every plane") {
    const PoseHierarchy hierarchy = three_leaves();
    CHECK(leaf_of(hierarchy, at(-1, 1)) == 0);
    CHECK(leaf_of(hierarchy, at(1, -1)) == 1);
    CHECK(leaf_of(hierarchy, at(1, 1)) == 2);
    CHECK(leaf_of(hierarchy, at(0, 0)) == 0);  // on planes: below

    MatrixF poses = MatrixF::Zero(2, 6);
    poses.row(1) << 9, 9, 9, 1, -1, 9;
    CHECK(leaves_of(hierarchy, poses) == std::vector<int32_t>{0, 1});
    CHECK_THROWS_AS(leaves_of(hierarchy, MatrixF::Zero(1, 5)), std::invalid_argument);
}

TEST_CASE("soft leaves pass over a plane without a jump") {
    const PoseHierarchy hierarchy = three_leaves();
    CHECK(soft_leaves(hierarchy, at(-0.1, 0.1), 0) == std::vector<LeafWeight>{{0, 1}});
    CHECK(soft_leaves(hierarchy, at(1, 0.1), 0.3)[0].leaf == 1);

    std::vector<double> before;
    for (double x = -1; x <= 1; x += 1.0 / 64) {
        std::vector<double> weights(3, 0.0);
        double sum = 0;
        for (const LeafWeight& one : soft_leaves(hierarchy, at(x, x / 4), 0.3)) {
            CHECK(one.weight > 0);
            weights[static_cast<size_t>(one.leaf)] = one.weight;
            sum += one.weight;
        }
        CHECK(sum == Approx(1));
        for (size_t leaf = 0; leaf < before.size(); ++leaf) {
            CHECK(std::abs(weights[leaf] - before[leaf]) < 0.05);
        }
        before = weights;
    }
    CHECK(before[0] == 0);
    CHECK(before[1] == Approx(1.0 / 12));
}

TEST_CASE("distances between leaves are in mm and leave the origin out") {
    const PoseHierarchy hierarchy = three_leaves();
    CHECK(leaf_distance(hierarchy, 1, 2) == Approx(20));
    CHECK(leaf_distance(hierarchy, 0, 0) == 0);
    CHECK(compared_markers(93) == 30);
}

TEST_CASE("a pose of a leaf's line comes back whole, another without what is off it") {
    const PoseHierarchy hierarchy = three_leaves();
    const std::vector<float> pose{0, 0, 0, -2, 0, 0.5F};
    const VectorD coordinates = leaf_coordinates(hierarchy, 0, pose);
    REQUIRE(coordinates.size() == 1);
    CHECK(coordinates[0] == Approx(0.5));
    CHECK(pose_error(pose, pose_at(hierarchy, 0, coordinates)) == Approx(0).margin(1e-9));

    const std::vector<float> beside{0, 0, 0, -2, 0.25F, 0.5F};
    CHECK(pose_error(beside, pose_at(hierarchy, 0, leaf_coordinates(hierarchy, 0, beside))) ==
          Approx(2.5));
}

TEST_CASE("a hierarchy travels whole") {
    const PoseHierarchy hierarchy = three_leaves();
    const auto copy = unpacked<PoseHierarchy>(packed(hierarchy));
    CHECK(packed(copy) == packed(hierarchy));
    CHECK(copy.nodes[2].parent == 0);
    CHECK(copy.bases == hierarchy.bases);
}

}  // namespace
}  // namespace kinetome
