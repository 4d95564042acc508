#include "kinetome/models/retarget.h"

#include <catch2/catch.hpp>

#include "features/small_body.h"

using namespace kinetome;
using namespace small_body;

namespace {

/// The small body with all its bones longer.
std::shared_ptr<const Skeleton> grown(double by) {
    const Skeleton body = skeleton();
    std::vector<Joint> joints = body.joints();
    for (Joint& joint : joints) joint.offset_after *= by;
    Skeleton result("grown", joints);
    for (int role = 0; role < joint_role_count; ++role) {
        result.set_role(JointRole(role), body.role(JointRole(role)));
    }
    return std::make_shared<const Skeleton>(result);
}

}  // namespace

TEST_CASE("a body that is larger all over makes the same motion larger all over") {
    const Clip clip{grown(1), wandering(50), 120.0};
    const Clip larger = retarget(clip, grown(1.25));
    const MatrixF expected = 1.25f * joint_positions(clip);
    CHECK((joint_positions(larger) - expected).cwiseAbs().maxCoeff() < 1e-3f);
    CHECK(leg_length(*larger.skeleton) == Approx(1.25 * leg_length(*clip.skeleton)));
    CHECK(leg_length(*clip.skeleton) == Approx(std::hypot(80, 2)));
}

TEST_CASE("a clip that has the skeleton is kept to the bit") {
    const Clip clip{grown(1), wandering(50), 120.0};
    CHECK(retarget(clip, clip.skeleton).motion == clip.motion);
}

TEST_CASE("a motion is not put on a body of another class, or one without legs") {
    const Clip clip{grown(1), wandering(5), 120.0};
    const auto other = std::make_shared<const Skeleton>(
        skeleton({Channel::tx, Channel::ty, Channel::tz, Channel::rx, Channel::ry, Channel::rz}));
    CHECK_THROWS_WITH(retarget(clip, other), Catch::Contains("different classes"));
    const auto no_roles = std::make_shared<const Skeleton>("bare", skeleton().joints());
    CHECK_THROWS_WITH(retarget(clip, no_roles), Catch::Contains("'bare' has no leg"));
}
