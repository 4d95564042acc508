#include "kinetome/models/placed_signature.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <stdexcept>

#include "kinetome/base/random.h"
#include "kinetome/models/pose_hierarchy.h"

using namespace kinetome;

namespace {

constexpr int64_t columns = 60;

MatrixD random_matrix(const char* name, int64_t rows, int64_t width) {
    RandomStream random(5, name);
    MatrixD values(rows, width);
    for (Eigen::Index i = 0; i < values.size(); ++i) values.data()[i] = random.uniform() - 0.5;
    return values;
}

/// Leaves whose means lie in a space of ten dimensions, with two components each out of two more.
PoseHierarchy small_hierarchy() {
    constexpr int32_t leaves = 40;
    PoseHierarchy hierarchy;
    hierarchy.means =
        20 * random_matrix("leaves", leaves, 10) * random_matrix("directions", 10, columns);
    hierarchy.bases = MatrixD::Zero(leaves * columns, 2);
    for (int32_t leaf = 0; leaf < leaves; ++leaf) {
        hierarchy.bases(leaf * columns + 7, 0) = 1;
        hierarchy.bases(leaf * columns + 30, 1) = 1;
        HierarchyNode node;
        node.leaf = leaf;
        node.rows = 1 + leaf;
        hierarchy.nodes.push_back(node);
    }
    hierarchy.tolerance = 20;
    return hierarchy;
}

}  // namespace

TEST_CASE("positions are as far apart as poses of the hierarchy are, mm per marker") {
    const PoseHierarchy hierarchy = small_hierarchy();
    const MatrixF axes = signature_axes(hierarchy);
    REQUIRE(axes.rows() == columns);
    REQUIRE(axes.cols() == 24);
    const auto pose = [&](int32_t leaf, double first, double second) {
        return pose_at(hierarchy, leaf, VectorD(Eigen::Vector2d(first, second)));
    };
    MatrixD poses(4, columns);
    poses << pose(3, 0, 0).transpose(), pose(3, 4, -9).transpose(), pose(20, 8, 0).transpose(),
        pose(39, 0, 5).transpose();
    const MatrixF positions = positions_of(poses, axes);
    for (Eigen::Index a = 0; a < 4; ++a) {
        for (Eigen::Index b = 0; b < a; ++b) {
            const VectorF one = poses.row(a).transpose().cast<float>();
            const double apart =
                pose_error(std::span(one.data(), size_t(columns)), poses.row(b).transpose());
            CHECK((positions.row(a) - positions.row(b)).norm() == Approx(apart).epsilon(1e-4));
        }
    }
}

TEST_CASE("poses of few columns have as many axes") {
    PoseHierarchy hierarchy;
    hierarchy.means = MatrixD::Zero(1, 9);
    hierarchy.bases = MatrixD::Zero(9, 1);
    hierarchy.nodes.resize(1);
    hierarchy.nodes[0].leaf = 0;
    hierarchy.nodes[0].rows = 4;
    const MatrixF axes = signature_axes(hierarchy);
    CHECK(axes.cols() == 9);
    MatrixD poses = MatrixD::Zero(2, 9);
    poses.row(1) << 0, 0, 0, 3, 0, 4, 0, 5, 0;  // both compared markers are 5 cm away
    const MatrixF positions = positions_of(poses, axes);
    CHECK((positions.row(0) - positions.row(1)).norm() == Approx(50));
}

TEST_CASE("runs lie where the means of their poses do") {
    MatrixF poses = MatrixF::Zero(3, 9);
    poses.row(1) << 0, 0, 0, 2, 0, 0, 0, 0, 2;
    poses.row(2) << 0, 0, 0, 9, 9, 9, 9, 9, 9;
    const Signature runs{{5, 0, 2}, {1, 2, 1}};
    MatrixD means(2, 9);
    means << 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 9, 9, 9, 9, 9, 9;
    const MatrixF axes = MatrixF::Identity(9, 9);
    const PlacedSignature placed = place_signature(runs, poses, axes);
    CHECK(placed.runs == runs);
    CHECK(placed.positions == means.cast<float>());
    CHECK_THROWS_AS(place_signature(runs, poses.topRows(2), axes), std::invalid_argument);
}
