#include "kinetome/formats/joint_roles.h"

#include <catch2/catch.hpp>
#include <string>

#include "kinetome/base/error.h"
#include "real_takes.h"
#include "small_rig.h"
#include "support/temporary_folder.h"
#include "support/test_corpus.h"

using namespace kinetome;
using Catch::Contains;

namespace {

Skeleton rig(const std::vector<std::string>& names) {
    std::vector<Joint> joints;
    for (const std::string& name : names) {
        Joint joint;
        joint.name = name;
        joint.parent = joints.empty() ? -1 : 0;
        joints.push_back(joint);
    }
    return Skeleton("rig", joints);
}

const JointMap map_to_abc = {{JointRole::root, "a"},       {JointRole::head, "b"},
                             {JointRole::left_wrist, "c"}, {JointRole::right_wrist, "d"},
                             {JointRole::left_ankle, "e"}, {JointRole::right_ankle, "f"},
                             {JointRole::left_hip, "g"},   {JointRole::right_hip, "h"}};

}  // namespace

TEST_CASE("every rig of the corpus has all its roles") {
    const auto corpus = test_corpus();
    if (!corpus) return;
    for (const RealTake& take : real_takes(*corpus)) {
        Skeleton skeleton = parse_asf(take.asf, take.asf_path);
        assign_roles(skeleton, take.asf_path);
        for (int role = 0; role < joint_role_count; ++role) {
            CHECK(skeleton.role(static_cast<JointRole>(role)) >= 0);
        }
        CHECK(skeleton.role(JointRole::left_wrist) == skeleton.find("lwrist"));
        CHECK(skeleton.role(JointRole::right_ankle) == skeleton.find("rtibia"));
    }
}

TEST_CASE("an unknown naming scheme is refused, listing joints found and roles missing") {
    Skeleton skeleton = *small_skeleton();
    try {
        assign_roles(skeleton, "small.asf");
        FAIL("it was accepted");
    } catch (const InputError& error) {
        CHECK_THAT(error.what(), Catch::StartsWith("small.asf: unknown joint naming scheme"));
        CHECK_THAT(error.what(), Contains("roles missing: head, left_wrist, right_wrist"));
        CHECK_THAT(error.what(), Contains("'thigh', 'shin', 'foot'"));
        CHECK_THAT(error.what(), Contains("--joint-map"));
    }
}

TEST_CASE("a hostile joint name is listed without its escape codes") {
    Skeleton skeleton = rig({"\x1b[31m"});
    CHECK_THROWS_WITH(assign_roles(skeleton, "a"), Contains("'\\x1b[31m'"));
}

TEST_CASE("a joint map helps where no scheme does, and has the last word where one does") {
    Skeleton unknown = rig({"a", "b", "c", "d", "e", "f", "g", "h"});
    assign_roles(unknown, "a.asf", &map_to_abc);
    CHECK(unknown.role(JointRole::left_ankle) == 4);
    CHECK(unknown.role(JointRole::left_toes) == -1);

    Skeleton known = rig({"root", "head", "lwrist", "rwrist", "ltibia", "rtibia", "lhand",
                          "lhipjoint", "rhipjoint"});
    const JointMap hand = {{JointRole::left_wrist, "lhand"}};
    assign_roles(known, "a.asf", &hand);
    CHECK(known.role(JointRole::left_wrist) == 6);
    CHECK(known.role(JointRole::right_wrist) == 3);
}

TEST_CASE("a joint map that names no joint of the rig is refused") {
    Skeleton skeleton = rig({"root", "head"});
    CHECK_THROWS_WITH(assign_roles(skeleton, "a.asf", &map_to_abc),
                      Contains("'a'") && Contains("root"));
}

TEST_CASE("a joint map is read from TOML, what is no role or no name is refused") {
    const TemporaryFolder folder;
    const JointMap map =
        load_joint_map(folder.write("map.toml", "left_ankle = \"LeftFoot\"\nhead = 'Head'\n"));
    CHECK(map.size() == 2);
    CHECK(map.at(JointRole::left_ankle) == "LeftFoot");
    CHECK_THROWS_WITH(load_joint_map(folder.write("role.toml", "left_ankel = 'a'")),
                      Contains("'left_ankel'"));
    CHECK_THROWS_AS(load_joint_map(folder.write("name.toml", "head = 3")), UsageError);
    CHECK_THROWS_AS(load_joint_map(folder.write("broken.toml", "head = ")), UsageError);
    CHECK_THROWS_AS(load_joint_map(folder / "none.toml"), UsageError);
}
