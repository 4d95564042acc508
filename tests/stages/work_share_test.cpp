#include "kinetome/stages/work_share.h"

#include <catch2/catch.hpp>

using namespace kinetome;

TEST_CASE("one rank does everything itself") {
    CHECK(share_out({5, 900, 0}, 1, true) == std::vector<int>{0, 0, 0});
}

TEST_CASE("work goes to the rank with the least to do, largest first") {
    CHECK(share_out({10, 50, 30, 40}, 2, false) == std::vector<int>{0, 0, 1, 1});
    CHECK(share_out({7, 7, 7, 7}, 2, false) == std::vector<int>{0, 1, 0, 1});
}

TEST_CASE("more ranks than work leaves some idle") {
    CHECK(share_out({3, 4}, 5, false) == std::vector<int>{1, 0});
    CHECK(share_out({}, 5, true).empty());
}

TEST_CASE("a partition beyond a rank's part is everybody's, the others one rank's each") {
    CHECK(share_out({60, 20, 20}, 2, true) == std::vector<int>{all_ranks, 0, 1});
    CHECK(share_out({50, 50}, 2, true) == std::vector<int>{0, 1});
    CHECK(share_out({100}, 3, true) == std::vector<int>{all_ranks});
}
