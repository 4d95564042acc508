#include "kinetome/models/bundle_link_rows.h"

#include <catch2/catch.hpp>
#include <memory>
#include <stdexcept>

#include "kinetome/synthesis/clip_variation.h"
#include "kinetome/synthesis/take.h"

using namespace kinetome;

TEST_CASE("rows that bundles are compared by are the same for a larger body") {
    const TakePlan plan = plan_take(0, 360, 0, 1, 5);
    const Clip clip = perform(plan, make_subject(plan.subject, 5), 5);
    const MatrixF rows = bundle_link_rows(clip);
    REQUIRE(rows.rows() == 45);
    REQUIRE(rows.cols() == 99);
    CHECK((bundle_link_rows(scaled(clip, 1.3)) - rows).cwiseAbs().maxCoeff() < 1e-4F);
    CHECK((rows.bottomRows(1) - rows.topRows(1)).cwiseAbs().maxCoeff() > 0.01F);
}

TEST_CASE("bundles of a body without elbows are not compared") {
    const TakePlan plan = plan_take(0, 60, 0, 1, 5);
    Clip clip = perform(plan, make_subject(plan.subject, 5), 5);
    CHECK(has_bundle_link_rows(*clip.skeleton));
    auto armless = std::make_shared<Skeleton>(*clip.skeleton);
    armless->set_role(JointRole::left_elbow, -1);
    CHECK_FALSE(has_bundle_link_rows(*armless));
    clip.skeleton = armless;
    CHECK_THROWS_AS(bundle_link_rows(clip), std::invalid_argument);
}
