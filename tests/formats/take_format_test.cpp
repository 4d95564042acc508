#include "kinetome/formats/take_format.h"

#include <catch2/catch.hpp>

#include "small_rig.h"

using namespace kinetome;

TEST_CASE("a format is found by its extension in any case, and only by a whole one") {
    REQUIRE(find_take_format(".amc") != nullptr);
    CHECK(find_take_format(".AMC") == find_take_format(".amc"));
    CHECK(find_take_format(".am") == nullptr);
    CHECK(find_take_format("amc") == nullptr);
    CHECK(find_take_format("") == nullptr);
}

TEST_CASE("a take read through the table is the take its parser reads") {
    const std::string text = small_amc(2);
    const TakeFormat& format = *find_take_format(".amc");
    CHECK(format.skeleton_extension == ".asf");
    CHECK(format.count_frames(text) == 2);
    const Clip clip = format.parse({text, "take.amc", small_skeleton(), 60.0});
    CHECK(clip.rate == 60.0);
    CHECK(clip.motion == parse_amc(text, "take.amc", small_skeleton()).motion);
}
