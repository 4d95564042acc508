#include "kinetome/models/subject_partition.h"

#include <catch2/catch.hpp>

using namespace kinetome;

TEST_CASE("only a corpus above the limit is parted automatically") {
    CHECK_FALSE(partition_by_subject(PartitionRule::automatic, 0));
    CHECK_FALSE(partition_by_subject(PartitionRule::automatic, most_frames_together));
    CHECK(partition_by_subject(PartitionRule::automatic, most_frames_together + 1));
    CHECK_FALSE(partition_by_subject(PartitionRule::none, 1'000'000'000));
    CHECK(partition_by_subject(PartitionRule::subject, 1));
}

TEST_CASE("a take's subject is the folder it lies in") {
    CHECK(subject_of("14/14_14.amc") == "14");
    CHECK(subject_of("cmu/14/14_14.amc") == "cmu/14");
    CHECK(subject_of("hdm05/14/14_14.amc") != subject_of("cmu/14/14_14.amc"));
    CHECK(subject_of("take.amc").empty());
}

TEST_CASE("a pattern takes the subject from anywhere in the path") {
    const std::regex first_number("([0-9]+)_[0-9]+\\.amc$");
    CHECK(subject_of("all/14_03.amc", first_number) == "14");
    CHECK(subject_of("all/07_03.amc", first_number) == "07");
    CHECK(subject_of("all/hopping.amc", first_number) == "all");
    CHECK_THROWS_WITH(subject_of("all/14_03.amc", std::regex("[0-9]+")),
                      Catch::Contains("parentheses"));
}
