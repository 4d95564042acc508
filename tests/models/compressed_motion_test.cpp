#include "kinetome/models/compressed_motion.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "kinetome/base/random.h"
#include "kinetome/features/markers.h"
#include "kinetome/formats/kinematics.h"
#include "kinetome/synthesis/take.h"

using namespace kinetome;

namespace {

/// Two leaves of two dimensions over poses of three markers, parted by the third column.
PoseHierarchy two_leaves() {
    PoseHierarchy hierarchy;
    hierarchy.principal_columns = {3};
    hierarchy.nodes.resize(3);
    hierarchy.nodes[0] = {-1, 1, 2, -1, 0, 0.0, 1.0};
    hierarchy.nodes[1].leaf = 0;
    hierarchy.nodes[2].leaf = 1;
    hierarchy.normals = MatrixD::Zero(3, 1);
    hierarchy.normals(0, 0) = 1;
    hierarchy.means = MatrixD::Zero(2, 9);
    hierarchy.means.row(0) << 0, 0, 0, -20, 100.123, 3, 40, 5, 6;
    hierarchy.means.row(1) << 0, 0, 0, 22, 90, 3, 45, 5, 8;
    hierarchy.bases = MatrixD::Zero(18, 2);
    hierarchy.bases(3, 0) = hierarchy.bases(12, 0) = 0.6;
    hierarchy.bases(6, 0) = hierarchy.bases(15, 0) = 0.8;
    hierarchy.bases(7, 1) = hierarchy.bases(16, 1) = 1;
    return hierarchy;
}

struct Example {
    PoseHierarchy hierarchy = two_leaves();
    LeafModels models{hierarchy, {0, 1}};
    LeafFrames frames;
    MotionSteps steps;

    explicit Example(int64_t count = 200) {
        RandomStream random(2, "frames");
        frames.coordinates.resize(count, 2);
        frames.root.resize(count, 4);
        int32_t model = 0;
        for (Eigen::Index i = 0; i < count; ++i) {
            if (random.below(9) == 0) model = 1 - model;
            frames.models.push_back(model);
            frames.coordinates.row(i) << 9 * std::sin(double(i) / 9), random.uniform(-300, 300);
            frames.root.row(i) << double(i), 90 + random.uniform(), -2 * double(i), double(i) / 50;
        }
    }
    LeafFrames part(int64_t first, int64_t end) const {
        return {{frames.models.begin() + first, frames.models.begin() + end},
                frames.coordinates.middleRows(first, end - first),
                frames.root.middleRows(first, end - first)};
    }
};

}  // namespace

TEST_CASE("models come back from their bytes as they were used") {
    const Example example;
    const LeafModels again(example.models.bytes());
    CHECK(again.leaves() == example.models.leaves());
    const VectorD coordinates = VectorD::LinSpaced(2, -3, 40);
    for (int64_t model = 0; model < 2; ++model) {
        CHECK(again.pose(model, coordinates) == example.models.pose(model, coordinates));
    }
    CHECK((example.models.pose(0, coordinates) - pose_at(example.hierarchy, 0, coordinates))
              .cwiseAbs()
              .maxCoeff() < 0.01);
}

TEST_CASE("a block comes back to half a step of each number") {
    const Example example;
    const LeafFrames& frames = example.frames;
    const LeafFrames again =
        decode_block(encode_block(frames, example.steps), example.models, example.steps);
    CHECK(again.models == frames.models);
    const double slack = 1e-9;
    CHECK((again.coordinates - frames.coordinates).cwiseAbs().maxCoeff() <=
          example.steps.coordinate / 2 + slack);
    CHECK((again.root - frames.root).leftCols(3).cwiseAbs().maxCoeff() <=
          example.steps.place / 2 + slack);
    CHECK((again.root - frames.root).col(3).cwiseAbs().maxCoeff() <=
          example.steps.heading / 2 + slack);
}

TEST_CASE("an empty block is a block") {
    const Example example(0);
    const LeafFrames again =
        decode_block(encode_block(example.frames, example.steps), example.models, example.steps);
    CHECK(again.models.empty());
    CHECK(poses_of(again, example.models, {}).rows() == 0);
}

TEST_CASE("damaged blocks and models are refused, whatever byte is wrong") {
    const Example example(30);
    const std::string block = encode_block(example.frames, example.steps);
    const std::string models = example.models.bytes();
    for (size_t length = 0; length < block.size(); ++length) {
        CHECK_THROWS_AS(decode_block(block.substr(0, length), example.models, example.steps),
                        std::out_of_range);
    }
    for (size_t length = 0; length < models.size(); ++length) {
        CHECK_THROWS_AS(LeafModels(std::string_view(models).substr(0, length)), std::out_of_range);
    }
    CHECK_THROWS_AS(decode_block(block + '\0', example.models, example.steps), std::out_of_range);
    for (size_t at = 0; at < block.size(); ++at) {  // decoded to something, or refused
        std::string damaged = block;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
        try {
            decode_block(damaged, example.models, example.steps);
        } catch (const std::out_of_range&) {
        }
    }
}

TEST_CASE("blending leaves a smooth motion alone and takes the leap out of others") {
    Example example(40);
    const LeafBlend blend;
    const auto leap = [&](const MatrixF& poses) {
        return double((poses.row(20) - poses.row(19)).norm());
    };
    // Both sides at rest, 10 cm apart along a direction that both models have.
    for (Eigen::Index i = 0; i < 40; ++i) {
        example.frames.models[size_t(i)] = i < 20 ? 0 : 1;
        example.frames.coordinates.row(i).setZero();
    }
    const MatrixF raw = poses_of(example.frames, example.models, {0});
    const MatrixF blended = poses_of(example.frames, example.models, blend);
    CHECK(leap(blended) < 1e-4);
    const double step = leap(raw) / (2 * double(blend.frames));
    for (Eigen::Index i = 1; i < 40; ++i) {
        CHECK(double((blended.row(i) - blended.row(i - 1)).norm()) <= step + 1e-4);
    }
    CHECK(blended.topRows(20 - blend.frames) == raw.topRows(20 - blend.frames));
    CHECK(blended.bottomRows(20 - blend.frames) == raw.bottomRows(20 - blend.frames));
}

TEST_CASE("what a part is blended to does not depend on what is decoded with it") {
    const Example example;
    const LeafBlend blend;
    const MatrixF whole = poses_of(example.frames, example.models, blend);
    for (int64_t first = 0; first < 200; first += 7) {
        for (int64_t end = first + 1; end <= 200; end += 13) {
            const int64_t from = std::max<int64_t>(0, first - blend.margin());
            const int64_t to = std::min<int64_t>(200, end + blend.margin());
            const MatrixF part = poses_of(example.part(from, to), example.models, blend);
            REQUIRE(part.middleRows(first - from, end - first) ==
                    whole.middleRows(first, end - first));
        }
    }
}

TEST_CASE("root and heading bring normalised markers back to where they were") {
    const Clip clip = perform(plan_take(3, 300, 1, 1, 5), make_subject(1, 5), 5);
    const MatrixF positions = joint_positions(clip);
    const MatrixF normalised = normalised_markers(*clip.skeleton, clip.motion, positions);
    const MatrixD root = root_track(positions, normalised);
    CHECK((world_positions(normalised, root) - positions).cwiseAbs().maxCoeff() < 1e-2F);
    for (Eigen::Index i = 1; i < root.rows(); ++i) {
        CHECK(std::abs(root(i, 3) - root(i - 1, 3)) < 1);
    }
}

TEST_CASE("errors are summed up as mean, root mean square, 95 % and greatest") {
    std::vector<double> errors;
    for (int i = 100; i >= 1; --i) errors.push_back(i);
    const PoseErrors summary = summary_of(errors);
    CHECK(summary.mean == Approx(50.5));
    CHECK(summary.rms == Approx(std::sqrt(338350.0 / 100)));
    CHECK(summary.share_95 == 95);
    CHECK(summary.greatest == 100);
    CHECK(summary_of({}).greatest == 0);
}
