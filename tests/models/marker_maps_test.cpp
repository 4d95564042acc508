#include "kinetome/models/marker_maps.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "kinetome/base/random.h"
#include "kinetome/models/hierarchy_growth.h"
#include "toy_poses.h"

using namespace kinetome;

namespace {

using Columns = std::vector<int32_t>;
const Columns principal{3, 4, 5, 9, 10, 11};

GrownHierarchy grown_from(const MatrixF& poses, MarkerMapRule rule) {
    PoseHierarchyOptions options;
    options.dimension = 2;
    options.leaf_tolerance = 30;
    options.maps.rule = rule;
    const MatrixF values = columns_of(poses, principal);
    return grow_pose_hierarchy(MatrixRows(poses), MatrixRows(values), principal, options,
                               Workers(1), 100);
}

/// RMS error of estimates, mm per marker.
double estimation_error(const GrownHierarchy& model, const MatrixF& poses, double band) {
    double squared = 0;
    for (int64_t i = 0; i < poses.rows(); ++i) {
        const std::span<const float> pose(poses.data() + i * poses.cols(),
                                          static_cast<size_t>(poses.cols()));
        const VectorD estimate = estimate_pose(model.hierarchy, model.maps,
                                               principal_values(model.hierarchy, pose), band);
        squared += std::pow(pose_error(pose, estimate), 2);
    }
    return std::sqrt(squared / double(poses.rows()));
}

}  // namespace

TEST_CASE("markers that follow the principal ones linearly are estimated exactly") {
    MatrixF poses = swinging_poses(2000);
    poses.rightCols(6) = 2 * poses.middleCols(3, 6) - poses.middleCols(9, 6);
    poses.middleCols(6, 3) = poses.middleCols(3, 3);
    poses.rightCols(3) = poses.middleCols(9, 3);
    poses.middleCols(12, 3) = 2 * poses.middleCols(3, 3) - poses.middleCols(9, 3);
    CHECK(estimation_error(grown_from(poses, MarkerMapRule::least_squares), poses, 0) < 1e-3);
    CHECK(estimation_error(grown_from(poses, MarkerMapRule::shrinkage), poses, 0) < 0.5);
}

TEST_CASE("shrinkage carries over to stretches that were not seen, least squares does not") {
    const MatrixF poses = swinging_poses(6000);
    std::vector<int64_t> seen, unseen;
    for (int64_t i = 0; i < poses.rows(); ++i) (i / 100 % 5 == 0 ? unseen : seen).push_back(i);
    const MatrixF training = poses(seen, Eigen::all), test = poses(unseen, Eigen::all);
    const double shrunk = estimation_error(grown_from(training, MarkerMapRule::shrinkage), test, 0);
    const double least =
        estimation_error(grown_from(training, MarkerMapRule::least_squares), test, 0);
    CHECK(shrunk < 0.9 * least);
}

TEST_CASE("the root's map is least squares against a little noise") {
    const MatrixF poses = swinging_poses(500);
    const Moments moments = moments_of(poses);
    const MarkerMap map = fit_marker_map(moments, principal, nullptr, {});
    const Columns others = estimated_columns(18, principal);
    MatrixD inner = moments.scatter(principal, principal);
    inner.diagonal().array() += 0.25;  // (5 mm)²
    const MatrixD between = moments.scatter(principal, others);
    CHECK((inner * map.map).isApprox(between, 1e-9));

    // Without poses of its own a child has its parent's map.
    Moments nothing{1, moments.mean, MatrixD::Zero(18, 18)};
    CHECK(fit_marker_map(nothing, principal, &map, {}).map.isApprox(map.map, 1e-9));
}

TEST_CASE("a leaf whose markers move less than the noise keeps its parent's map") {
    // Two principal markers that go together but for a millimetre, which the other one magnifies a
    // hundred times in these poses, and not at all in those of the parent.
    RandomStream random(5, "noise");
    MatrixF poses = MatrixF::Zero(20000, 12);
    for (int64_t i = 0; i < poses.rows(); ++i) {
        const auto swing = float(20 * random.normal()), apart = float(0.1 * random.normal());
        poses(i, 3) = swing;
        poses(i, 6) = swing + apart;
        poses(i, 9) = swing + 100 * apart;
    }
    const Columns known{3, 6};
    const auto others = estimated_columns(12, known);
    const auto estimated = std::ranges::find(others, 9) - others.begin();
    const MarkerMap parent{MatrixD::Zero(2, 10), MatrixD::Identity(2, 2)};
    const auto slope = [&](double noise) {
        MarkerMapOptions options;
        options.noise = noise;
        return fit_marker_map(moments_of(poses), known, &parent, options).map(1, estimated);
    };
    CHECK(std::abs(slope(5)) < 5);
    CHECK(slope(0.01) > 1.5 * std::abs(slope(5)));  // what it is kept from
}

TEST_CASE("blending takes the jump out of estimates where the leaf changes") {
    const MatrixF poses = swinging_poses(4000);
    const GrownHierarchy model = grown_from(poses, MarkerMapRule::shrinkage);
    const PoseHierarchy& hierarchy = model.hierarchy;
    double hard = 0, soft = 0;
    int changes = 0;
    const auto estimate = [&](const VectorD& values, double band) {
        return estimate_pose(hierarchy, model.maps, values, band);
    };
    for (int64_t i = 1; i < poses.rows(); ++i) {
        VectorD before = poses(i - 1, principal).cast<double>();
        VectorD after = poses(i, principal).cast<double>();
        if (leaf_of(hierarchy, before) == leaf_of(hierarchy, after)) continue;
        for (int halving = 0; halving < 30; ++halving) {  // down to where the leaf changes
            const VectorD middle = (before + after) / 2;
            (leaf_of(hierarchy, middle) == leaf_of(hierarchy, before) ? before : after) = middle;
        }
        hard += (estimate(after, 0) - estimate(before, 0)).norm();
        soft += (estimate(after, default_blend_band) - estimate(before, default_blend_band)).norm();
        ++changes;
    }
    REQUIRE(changes > 20);
    CHECK(hard / changes > 0.1);  // cm
    CHECK(soft / changes < 1e-3 * hard / changes);
}
