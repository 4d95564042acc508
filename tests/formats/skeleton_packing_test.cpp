#include "kinetome/formats/skeleton_packing.h"

#include <catch2/catch.hpp>

#include "small_rig.h"

using namespace kinetome;

TEST_CASE("a packed skeleton comes back whole, and not from fewer bytes") {
    const auto skeleton = small_skeleton();
    const std::string bytes = packed(*skeleton);
    const auto again = unpacked<Skeleton>(bytes);
    CHECK(packed(again) == bytes);
    CHECK(again.class_name() == skeleton->class_name());
    CHECK(again.name() == skeleton->name());
    for (size_t length = 0; length < bytes.size(); ++length) {
        CHECK_THROWS_AS(unpacked<Skeleton>(bytes.substr(0, length)), std::out_of_range);
    }
}
