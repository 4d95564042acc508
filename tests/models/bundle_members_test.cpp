#include "kinetome/models/bundle_members.h"

#include <catch2/catch.hpp>
#include <vector>

using namespace kinetome;

namespace {

/// Letters of ten frames each, in one clip.
MotionString even_string(int32_t size) {
    MotionString string;
    for (int32_t letter = 0; letter < size; ++letter) {
        string.letters.push_back(letter);
        string.clip.push_back(0);
        string.first_frame.push_back(10 * letter);
        string.end_frame.push_back(10 * letter + 10);
    }
    return string;
}

/// Two occurrences, each short and long, two that are only short and one that is only long.
const std::vector<Substring> similar = {{0, 1},   {0, 3},   {10, 11}, {10, 13},
                                        {20, 21}, {30, 31}, {40, 43}};

}  // namespace

TEST_CASE(
    "of variants of one occurrence the one is a member whose length is nearest to the seed's") {
    const MotionString string = even_string(50);
    MemberChoice choice(string);
    choice.consider(similar);
    CHECK(choice.choose({0, 1}, 0).members ==
          std::vector<Substring>{{0, 1}, {10, 11}, {20, 21}, {30, 31}, {40, 43}});
    CHECK(choice.choose({0, 3}, 0).members ==
          std::vector<Substring>{{0, 3}, {10, 13}, {20, 21}, {30, 31}, {40, 43}});
}

TEST_CASE("by the mean the one is a member whose length is nearest to that of all variants") {
    const MotionString string = even_string(50);
    MemberChoice choice(string);
    choice.consider(similar);  // 18.6 frames on average: by ratio nearer to 30 than to 10
    const BundleMembers all = choice.choose_by_mean(0);
    CHECK(all.members == std::vector<Substring>{{0, 3}, {10, 13}, {20, 21}, {30, 31}, {40, 43}});
    CHECK(all.mean_frames == 22);
    // γ is held against the mean of those taken, 22 frames: by that of all the long ones would go.
    const BundleMembers alike = choice.choose_by_mean(0.7);
    CHECK(alike.members == std::vector<Substring>{{0, 3}, {10, 13}, {40, 43}});
    CHECK(alike.mean_frames == 30);
}
