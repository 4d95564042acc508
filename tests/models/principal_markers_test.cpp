#include "kinetome/models/principal_markers.h"

#include <catch2/catch.hpp>
#include <limits>

#include "kinetome/math/row_source.h"
#include "toy_poses.h"

using namespace kinetome;

namespace {

/// Seven markers: the origin, two that move on their own, and for each of them two that follow it,
/// less and less.
MatrixF leaders_and_followers() {
    RandomStream random(3, "leaders");
    MatrixF poses = MatrixF::Zero(2000, 21);
    for (int64_t i = 0; i < poses.rows(); ++i) {
        for (const int64_t leader : {1, 4}) {
            for (int64_t axis = 0; axis < 3; ++axis) {
                const double value = 10 * random.normal();
                for (int64_t follower = 0; follower < 3; ++follower) {
                    poses(i, 3 * (leader + follower) + axis) = static_cast<float>(
                        (1 - 0.1 * double(follower)) * value + 0.2 * random.normal());
                }
            }
        }
    }
    return poses;
}

}  // namespace

TEST_CASE("of markers that move together one is principal") {
    const auto found = select_principal_markers(moments_of(leaders_and_followers()), {});
    CHECK(found.components == 6);
    CHECK(found.residual < 10);
    bool first = false, second = false;
    for (const int32_t marker : found.markers) {
        first |= marker >= 1 && marker <= 3;
        second |= marker >= 4;
        CHECK(marker != 0);  // the origin never moves
    }
    CHECK(first);
    CHECK(second);
    CHECK(found.columns.size() == 3 * found.markers.size());
}

TEST_CASE("of several starts the set is kept that leaves the least residual") {
    const Moments moments = moments_of(swinging_poses(3000));
    PrincipalMarkerOptions options;
    const auto best = select_principal_markers(moments, options);
    options.starts = 1;
    for (uint64_t seed = 1; seed < 6; ++seed) {
        options.seed = seed;
        CHECK(select_principal_markers(moments, options).residual >= best.residual);
    }
}

TEST_CASE("a wider tolerance needs fewer components and no more markers") {
    const Moments moments = moments_of(leaders_and_followers());
    PrincipalMarkerOptions options;
    const auto fine = select_principal_markers(moments, options);
    options.tolerance = 150;
    const auto coarse = select_principal_markers(moments, options);
    CHECK(coarse.components < fine.components);
    CHECK(coarse.markers.size() <= fine.markers.size());
}

TEST_CASE("poses that do not move have no principal markers, and one without a place is named") {
    MatrixF poses = MatrixF::Constant(10, 9, 4);
    CHECK(select_principal_markers(moments_of(poses), {}).markers.empty());
    CHECK(select_principal_markers(moments_of(poses.topRows(1)), {}).columns.empty());
    poses(3, 7) = std::numeric_limits<float>::quiet_NaN();
    CHECK_THROWS_WITH(select_principal_markers(moments_of(poses), {}),
                      Catch::Contains("coordinate y of marker 2"));
}
