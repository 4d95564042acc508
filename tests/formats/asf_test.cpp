#include <catch2/catch.hpp>
#include <numbers>
#include <string>

#include "kinetome/base/error.h"
#include "kinetome/formats/asf_amc.h"
#include "replaced.h"
#include "small_rig.h"

using namespace kinetome;
using Catch::Contains;
using Catch::StartsWith;

namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double unit = 2.54 / 0.45;

const Joint& joint_named(const Skeleton& skeleton, const std::string& name) {
    return skeleton.joints()[static_cast<size_t>(skeleton.find(name).value())];
}

void check_refused(const std::string& text, const std::string& where, const std::string& why) {
    INFO(where << " " << why);
    try {
        parse_asf(text, "small.asf");
        FAIL("it was accepted");
    } catch (const InputError& error) {
        CHECK_THAT(error.what(), StartsWith("small.asf" + where));
        CHECK_THAT(error.what(), Contains(why));
    }
}

}  // namespace

TEST_CASE("joints come depth first with lengths in centimetres and angles in radians") {
    const Skeleton skeleton = parse_asf(small_asf, "small.asf");
    REQUIRE(skeleton.joint_count() == 6);
    CHECK(skeleton.name() == "SMALL");
    CHECK(skeleton.dof_count() == 15);
    CHECK(skeleton.joints()[0].name == "root");
    CHECK(skeleton.joints()[4].name == "foot");
    CHECK(skeleton.joints()[5].name == "spine");
    CHECK(skeleton.joints()[5].parent == 0);
    CHECK(skeleton.dof_names()[6] == "thigh.rx");
    CHECK(skeleton.dof_names()[12] == "spine.rz");

    const Joint& shin = joint_named(skeleton, "shin");
    CHECK(shin.offset_after.y() == Approx(-0.939693 * 6.5 * unit));
    REQUIRE(shin.limits.size() == 1);
    CHECK(shin.limits[0].second == Approx(170 * degree));
    CHECK(joint_named(skeleton, "foot").limits.empty());
    CHECK(skeleton.source_units().length == Approx(unit));
}

TEST_CASE("the length unit is the file's own, not CMU's") {
    const Skeleton skeleton = parse_asf(replaced(small_asf, "length 0.45", "length 0.363"), "a");
    CHECK(joint_named(skeleton, "spine").offset_after.y() == Approx(4 * 2.54 / 0.363));
}

TEST_CASE("an ASF in radians gives the joints of the same ASF in degrees") {
    std::string text = replaced(small_asf, "angle deg", "angle rad");
    text = replaced(text, "axis 10 -20 30 ZXY",
                    "axis 0.17453292519943295 -0.3490658503988659 0.5235987755982988 ZXY");
    const Joint expected = joint_named(*small_skeleton(), "spine");
    CHECK(joint_named(parse_asf(text, "a"), "spine").axes.isApprox(expected.axes, 1e-12));
}

TEST_CASE("the order of letters of an axis says which angle acts first") {
    // ZXY: z first. Where z lands: Ry·Rx·(z is fixed by Rz).
    const Eigen::Matrix3d axes = joint_named(*small_skeleton(), "spine").axes;
    const double x = 10 * degree;
    const double y = -20 * degree;
    const Eigen::Vector3d expected(std::cos(x) * std::sin(y), -std::sin(x),
                                   std::cos(x) * std::cos(y));
    CHECK((axes.col(2) - expected).norm() < 1e-12);
}

TEST_CASE("CRLF, tabs, comments, missing ids, infinite limits and another order are read alike") {
    const Skeleton expected = parse_asf(small_asf, "a");
    std::string text = replaced(small_asf, "    id 4\n", "");
    text = replaced(text, "    direction 0.08", "\tdirection\t0.08");
    text = replaced(text, "length 2\n", "length 2 # short\n");
    text = replaced(text, "(-10.0 170.0)", "(-inf inf)");
    std::string crlf;
    for (const char letter : text) crlf += letter == '\n' ? "\r\n" : std::string(1, letter);
    const Skeleton skeleton = parse_asf(crlf, "a");
    CHECK(skeleton.class_name() == expected.class_name());
    CHECK(std::isinf(joint_named(skeleton, "shin").limits[0].first));
    CHECK(joint_named(skeleton, "foot").offset_after == joint_named(expected, "foot").offset_after);
}

TEST_CASE("a hierarchy that stands before the bones gives the same joints") {
    const size_t bones = small_asf.find(":bonedata");
    const size_t hierarchy = small_asf.find(":hierarchy");
    const std::string text = small_asf.substr(0, bones) + small_asf.substr(hierarchy) +
                             small_asf.substr(bones, hierarchy - bones);
    CHECK(parse_asf(text, "a").class_name() == small_skeleton()->class_name());
}

TEST_CASE("the class of a skeleton depends on channels and parents, not on lengths") {
    const std::string name = small_skeleton()->class_name();
    CHECK_THAT(name, StartsWith("6j15d-"));
    CHECK(name.size() == 14);
    CHECK(parse_asf(replaced(small_asf, "length 6.5", "length 9"), "a").class_name() == name);
    CHECK(parse_asf(replaced(small_asf, "dof rx rz", "dof rz rx"), "a").class_name() != name);
    CHECK(parse_asf(replaced(small_asf, "hip thigh", "root thigh"), "a").class_name() != name);
}

TEST_CASE("an ASF that makes no sense is refused, naming the line and what was expected") {
    const auto change = [](const std::string& from, const std::string& to) {
        return replaced(small_asf, from, to);
    };
    check_refused("", "", "'length' in :units");
    check_refused(change("length 0.45", "length 0"), ":6", "a positive length unit, found '0'");
    check_refused(change("length 0.45", "length -1"), ":6", "a positive length unit, found '-1'");
    check_refused(change("length 0.45", "length nan"), ":6", "a finite number, found 'nan'");
    check_refused(change("  length 0.45\n", ""), ": ", "'length' in :units");
    check_refused(change("angle deg", "angle grad"), ":7", "'deg' or 'rad', found 'grad'");
    check_refused(change("order TX TY", "order QX TY"), ":11", "a degree of freedom");
    check_refused(change("dof rx ry rz", "dof rx ry rx"), ":29", "each degree of freedom once");
    check_refused(change("dof rx\n", "dof rx l\n"), ":40", "found 'l'");
    check_refused(change("axis 0 0 20 XYZ", "axis 0 0 20 XXZ"), ":28", "found 'XXZ'");
    check_refused(change("axis 0 0 20 XYZ", "axis 0 0 20"), ":28", "three angles and an order");
    check_refused(change("length 7", "length 7x"), ":27", "a finite number, found '7x'");
    check_refused(change("length 7", "length -7"), ":27", "a length of at least 0");
    check_refused(change("    length 7\n", ""), ":23", "a 'length' of bone 'thigh'");
    check_refused(change("    name thigh\n", ""), ":23", "a 'name'");
    check_refused(change("name thigh", "name hip"), ":23", "found 'hip' again");
    check_refused(change("name thigh", "name 3thigh"), ":25", "begins with a letter");
    check_refused(change("           (-60.0 70.0)\n", ""), ":23", "found 2 for 3");
    check_refused(change("(-60.0 70.0)", "(-60.0)"), ":33", "limits in pairs");
    check_refused(change("length 7", "length 1e308"), ":23", "a finite size of bone 'thigh'");
    check_refused(change("hip thigh", "hip knee"), ":62", "found 'knee'");
    check_refused(change("    hip thigh\n", ""), ":23", "bone 'thigh', found no parent");
    check_refused(change("hip thigh", "foot thigh"), ":23", "a cycle");
    check_refused(change("shin foot", "shin foot hip"), ":64", "'hip' attached again");
    check_refused(change("shin foot", "shin foot root"), ":64", "'root' below a bone");
    check_refused(small_asf.substr(0, small_asf.find(":hierarchy")), ": ", ":hierarchy");
    check_refused(small_asf.substr(0, small_asf.find("    dof rx\n")), ":34", "'end' of the bone");
    check_refused("\x1b[31m evil", ":1", "'\\x1b[31m'");
}

TEST_CASE("a file of thousands of bones is refused before anything walks its hierarchy") {
    std::string text = ":units\nlength 1\n:root\norder RX\n:bonedata\n";
    for (int i = 0; i < 5000; ++i) {
        text += "begin\nname b" + std::to_string(i) + "\ndirection 0 1 0\nlength 1\nend\n";
    }
    check_refused(text, ":", "at most 4096 bones");
}
