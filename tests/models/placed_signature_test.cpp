#include "kinetome/models/placed_signature.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
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

TEST_CASE("runs lie where the means of their poses do, samples where their own") {
    MatrixF poses = MatrixF::Zero(3, 9);
    poses.row(1) << 0, 0, 0, 2, 0, 0, 0, 0, 2;
    poses.row(2) << 0, 0, 0, 9, 9, 9, 9, 9, 9;
    const Signature runs{{5, 0, 2}, {1, 2, 1}};
    MatrixD means(2, 9);
    means << 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 9, 9, 9, 9, 9, 9;
    const MatrixF axes = MatrixF::Identity(9, 9);
    const PlacedSignature placed = place_signature(runs, poses, axes, 2);
    CHECK(placed.runs == runs);
    CHECK(placed.positions == means.cast<float>());
    CHECK(placed.sample_positions == poses(std::vector<int>{0, 2}, Eigen::all));
    CHECK_THROWS_AS(place_signature(runs, poses.topRows(2), axes, 2), std::invalid_argument);
    CHECK_THROWS_AS(place_signature(runs, poses, axes, 0), std::invalid_argument);
}

TEST_CASE("a pose with a missing marker has no position, whether it is sampled or not") {
    const Signature runs{{5, 0, 4}, {1, 4, 4}};
    const MatrixF axes = MatrixF::Identity(9, 9);
    for (const Eigen::Index missing : {4, 5}) {
        MatrixF poses = MatrixF::Zero(8, 9);
        poses.block(missing, 3, 1, 3).setConstant(std::numeric_limits<float>::quiet_NaN());
        CHECK_THROWS_WITH(place_signature(runs, poses, axes, 4), Catch::Contains("frames 4:8"));
    }
}

TEST_CASE("samples are every so many frames from the first, and the last") {
    const auto frames_of = [](const FrameSamples& samples) {
        std::vector<int64_t> frames;
        for (int64_t i = 0; i < samples.count(); ++i) frames.push_back(samples.frame(i));
        return frames;
    };
    CHECK(frames_of({17, 8}) == std::vector<int64_t>{0, 8, 16});
    CHECK(frames_of({18, 8}) == std::vector<int64_t>{0, 8, 16, 17});
    CHECK(frames_of({1, 8}) == std::vector<int64_t>{0});
    CHECK(frames_of({0, 8}).empty());
    CHECK(frames_of({3, 1}) == std::vector<int64_t>{0, 1, 2});
}

TEST_CASE("between samples positions follow the motion") {
    const FrameSamples samples{62, 8};  // the last two are five frames apart
    const auto motion = [](double frame, bool straight) {
        MatrixF position(1, 2);
        if (straight) {
            position << float(3 * frame - 7), float(frame);
        } else {
            position << float(100 * std::sin(frame / 20)), float(100 * std::cos(frame / 20));
        }
        return position;
    };
    for (const bool straight : {true, false}) {
        MatrixF positions(samples.count(), 2);
        for (Eigen::Index i = 0; i < positions.rows(); ++i) {
            positions.row(i) = motion(double(samples.frame(i)), straight);
        }
        const MatrixF between = positions_between(positions, samples, 0.5, 0.25, 240);
        for (Eigen::Index i = 0; i < between.rows(); ++i) {
            const double frame = 0.5 + 0.25 * double(i);
            const float off = (between.row(i) - motion(frame, straight)).norm();
            // The tangents at either end are those of the line to the next sample.
            const bool at_end = frame < 8 || frame > 56;
            CHECK(off < (straight ? 1e-4F : at_end ? 4.F : 0.5F));
        }
        CHECK(positions_between(positions, samples, 0, 8, 8) == positions.topRows(8));
        CHECK(positions_between(positions, samples, -9, 1, 1) == positions.row(0));
        CHECK(positions_between(positions, samples, 99, 1, 1) == positions.row(8));
    }
    const MatrixF one = MatrixF::Constant(1, 2, 5);
    CHECK(positions_between(one, {1, 8}, 0, 1, 3) == MatrixF::Constant(3, 2, 5));
}
