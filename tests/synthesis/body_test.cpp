#include "kinetome/synthesis/body.h"

#include <catch2/catch.hpp>

#include "kinetome/formats/kinematics.h"
#include "kinetome/synthesis/clip_variation.h"
#include "support/cmu_take.h"
#include "support/test_corpus.h"

using namespace kinetome;

TEST_CASE("a generated skeleton has the joints and degrees of freedom of CMU's scheme") {
    const Skeleton skeleton = make_skeleton(Body(), "01");
    CHECK(skeleton.joint_count() == 31);
    CHECK(skeleton.dof_count() == 62);
    for (int role = 0; role < joint_role_count; ++role) {
        INFO(joint_role_name(static_cast<JointRole>(role)));
        CHECK(skeleton.role(static_cast<JointRole>(role)) >= 0);
    }
}

TEST_CASE("a generated skeleton is of the class of CMU's takes, so that they share pose models") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    CHECK(make_skeleton(Body(), "01").class_name() ==
          cmu_take(*corpus, "02_01").skeleton->class_name());
}

TEST_CASE("a generated body is its own mirror image") {
    RandomStream random(1, "body test");
    const Skeleton skeleton = make_skeleton(random_body(random), "01");
    const Skeleton image = mirrored(skeleton);
    for (size_t j = 0; j < skeleton.joints().size(); ++j) {
        const Joint& own = skeleton.joints()[j];
        const Joint& other = image.joints()[j];
        INFO(own.name);
        CHECK((own.offset_after - other.offset_after).norm() < 1e-9);
        CHECK((own.axes - other.axes).norm() < 1e-9);
        CHECK(own.limits.size() == own.channels.size() * (own.parent >= 0));
    }
}

TEST_CASE("a body of 174 cm stands 174 cm tall, less what is above the head's joint") {
    const Skeleton skeleton = make_skeleton(Body(174), "01");
    double up = 0, down = 0;
    for (const char* name : {"lowerback", "upperback", "thorax", "lowerneck", "upperneck", "head"})
        up += skeleton.joints()[static_cast<size_t>(*skeleton.find(name))].offset_after.norm();
    const Body body(174);
    down = body.hip_drop + body.thigh + body.shin + body.ankle_height;
    CHECK(up + down > 150);
    CHECK(up + down < 174);
}

TEST_CASE("random bodies are of human size and differ") {
    RandomStream random(2, "body test");
    double shortest = 1e9, longest = 0;
    for (int i = 0; i < 200; ++i) {
        const Body body = random_body(random);
        shortest = std::min(shortest, body.leg());
        longest = std::max(longest, body.leg());
    }
    CHECK(shortest > 60);
    CHECK(longest < 115);
    CHECK(longest - shortest > 10);
}
