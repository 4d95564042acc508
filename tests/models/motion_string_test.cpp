#include "kinetome/models/motion_string.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>

#include "kinetome/base/random.h"
#include "kinetome/models/pose_clusters.h"
#include "random_mixture.h"

using namespace kinetome;

namespace {

/// One letter a frame, clips parted by spaces.
MotionString string_of(const std::string& text) {
    std::vector<int32_t> letters;
    std::vector<int64_t> frames = {0};
    for (const char letter : text) {
        if (letter == ' ') {
            frames.push_back(0);
        } else {
            letters.push_back(letter - 'A');
            ++frames.back();
        }
    }
    return make_motion_string(letters, frames);
}

std::string text_of(const MotionString& string) {
    std::string text;
    for (int64_t j = 0; j < string.size(); ++j) {
        text += static_cast<char>('A' + string.letters[static_cast<size_t>(j)]);
        if (string.breaks_after(j)) text += '|';
    }
    return text;
}

}  // namespace

TEST_CASE("sequential repetitions of a letter are removed") {
    // S1, Figure 1(b).
    CHECK(text_of(string_of("GGOOOAACEENN")) == "GOACEN|");
    CHECK(text_of(string_of("GOACCCHCEN")) == "GOACHCEN|");
}

TEST_CASE("a letter never spans a clip break, even where both sides are equal") {
    const MotionString string = string_of("GGOA AACEN N");
    CHECK(text_of(string) == "GOA|ACEN|N|");
    CHECK(string.clip == std::vector<int32_t>{0, 0, 0, 1, 1, 1, 1, 2});
    CHECK(string.first_frame == std::vector<int32_t>{0, 2, 3, 0, 2, 3, 4, 0});
    CHECK(string.end_frame == std::vector<int32_t>{2, 3, 4, 2, 3, 4, 5, 1});
}

TEST_CASE("empty clips keep their number and clips of one frame their letter") {
    const MotionString string = string_of(" A  BB C ");
    CHECK(text_of(string) == "A|B|C|");
    CHECK(string.clip == std::vector<int32_t>{1, 3, 4});
    CHECK(make_motion_string({}, {}).size() == 0);
    CHECK(string_of("").size() == 0);
}

TEST_CASE("F(j) covers each frame of each clip exactly once, with its own letter") {
    RandomStream random(5, "frames");
    std::vector<int32_t> letters;
    std::vector<int64_t> frames;
    for (int clip = 0; clip < 40; ++clip) {
        frames.push_back(static_cast<int64_t>(random.below(30)));
        for (int64_t i = 0; i < frames.back(); ++i)
            letters.push_back(static_cast<int32_t>(random.below(3)));
    }
    const MotionString string = make_motion_string(letters, frames);
    std::vector<int32_t> spelled;
    for (int64_t j = 0; j < string.size(); ++j) {
        const auto i = static_cast<size_t>(j);
        REQUIRE(string.first_frame[i] < string.end_frame[i]);
        const bool starts_clip = j == 0 || string.breaks_after(j - 1);
        REQUIRE(string.first_frame[i] == (starts_clip ? 0 : string.end_frame[i - 1]));
        if (string.breaks_after(j))
            REQUIRE(string.end_frame[i] == frames[static_cast<size_t>(string.clip[i])]);
        else
            REQUIRE(string.letters[i] != string.letters[i + 1]);
        spelled.insert(spelled.end(),
                       static_cast<size_t>(string.end_frame[i] - string.first_frame[i]),
                       string.letters[i]);
    }
    CHECK(spelled == letters);
}

TEST_CASE("letters that do not match the clips are refused") {
    const std::vector<int32_t> letters(10);
    const std::vector<int64_t> frames = {4, 5};
    CHECK_THROWS_AS(make_motion_string(letters, frames), std::invalid_argument);
}

TEST_CASE("tau is a quantile over adjacent letters inside clips, the lower of two") {
    // Letters at 0, 1, 3, 10, 500 with deviation 1: adjacent distances are differences.
    const Mixture mixture = mixture_on_line({0, 1, 3, 10, 500}, {1, 1, 1, 1, 1});
    const auto median = [&](const char* letters) {
        return adjacent_distance(string_of(letters), mixture, 0.5);
    };
    CHECK(median("ABCD") == Approx(2));          // 1 2 7
    CHECK(median("DCBABA") == Approx(1));        // 7 2 1 1 1
    CHECK(median("BCD") == Approx(2));           // 2 7
    CHECK(median("ABDCDCBE") == Approx(7));      // 1 9 7 7 7 2 499
    CHECK(median("ABC E BC E D") == Approx(2));  // the breaks leap over 500
    CHECK(median("A E A") == 0);
    CHECK(adjacent_distance(MotionString{}, mixture, 0.5) == 0);

    const MotionString string = string_of("DCBABE");  // 7 2 1 1 499
    CHECK(adjacent_distance(string, mixture, 0) == Approx(1));
    CHECK(adjacent_distance(string, mixture, 0.74) == Approx(2));
    CHECK(adjacent_distance(string, mixture, 0.75) == Approx(7));
    CHECK(adjacent_distance(string, mixture, 1) == Approx(499));
}

TEST_CASE("lambda counts the letters of a submotion of lambda' frames") {
    // Mean frames 0.5, 2 and 5.5: two pairs in five frames.
    CHECK(string_of("AABCCCCCC").mean_frame(0) == 0.5);
    CHECK(string_of("AABCCCCCC").mean_frame(2) == 5.5);
    CHECK(longest_substring(string_of("AABCCCCCC"), 20) == 8);
    CHECK(longest_substring(string_of("AABCCCCCC"), 6) == 2);  // 2.4
    CHECK(longest_substring(string_of("AABCCCCCC"), 7) == 3);  // 2.8
    // The second clip adds a pair over 2.5 frames; the leap between the clips counts for nothing.
    CHECK(longest_substring(string_of("AABCCCCCC DDDE"), 25) == 11);  // 25 · 3 / 7
    CHECK(longest_substring(string_of("AABCCCCCC D DDDE"), 25) == 11);
}

TEST_CASE("lambda is at least two letters") {
    CHECK(longest_substring(string_of("AABCCCCCC"), 1) == 2);
    CHECK(longest_substring(string_of("A A A"), 200) == 2);
    CHECK(longest_substring(MotionString{}, 200) == 2);
}
