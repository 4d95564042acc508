#include "kinetome/models/reach_tables.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

/// A take of random letters, each accessible from some others.
struct RandomTake {
    static constexpr int32_t letters = 24, length = 600, longest = 12;
    MotionString string;
    AccessibilityMatrix accessibility{letters};
    LetterIndex index;
    IntervalSet open{length};

    RandomTake() : string(random_string()), index(string, accessible()) {
        open.insert({0, length - 1});
    }
    MatchingContext context() const { return {string, accessibility, index, open, 2 * longest}; }

    /// All up to the longest, by first letter.
    std::vector<Substring> substrings() const {
        std::vector<Substring> all;
        for (int32_t first = 0; first + longest <= length; ++first) {
            for (int32_t last = first + 1; last < first + longest; ++last)
                all.push_back({first, last});
        }
        return all;
    }

  private:
    static MotionString random_string() {
        RandomStream random(1, "reach tables");
        std::vector<int32_t> frames;
        while (frames.size() < static_cast<size_t>(length)) {
            const auto letter = static_cast<int32_t>(random.below(letters));
            if (frames.empty() || frames.back() != letter) frames.push_back(letter);
        }
        return make_motion_string(frames, std::vector<int64_t>{length});
    }
    const AccessibilityMatrix& accessible() {
        RandomStream random(2, "reach tables");
        for (int32_t a = 0; a < letters; ++a) {
            for (int32_t b = a + 1; b < letters; ++b) {
                if (random.uniform() < 0.2) accessibility.set(a, b);
            }
        }
        return accessibility;
    }
};

using Tables = ReachTables<1>;

struct Match {
    int32_t column;
    std::vector<int32_t> starts;
    bool operator==(const Match&) const = default;
};

std::vector<Match> matches_of(const Tables& tables, const Substring& substring) {
    std::vector<Match> all;
    for (const auto& [column, starts] : tables.matches(substring)) {
        Match& match = all.emplace_back(Match{column, {}});
        starts.for_each([&](int32_t bit) { match.starts.push_back(bit); });
    }
    return all;
}

}  // namespace

TEST_CASE("reach tables that were given up are made again as they were") {
    const RandomTake take;
    const MatchingContext context = take.context();
    Tables all(context, {});
    const std::vector<Substring> substrings = take.substrings();
    for (const Substring& one : substrings) all.prepare({&one, 1});

    const uint64_t budget = all.bytes() / 20;
    Tables few(context, {.table_bytes = budget});
    // Twice, so that what was asked for first is asked for when it is long gone.
    for (int turn = 0; turn < 2; ++turn) {
        for (const Substring& one : substrings) {
            few.prepare({&one, 1});
            REQUIRE(matches_of(few, one) == matches_of(all, one));
            REQUIRE(few.bytes() <= budget);
        }
    }
    CHECK(few.bytes() > 0);
}

TEST_CASE("reach tables just asked for are kept whatever they take") {
    const RandomTake take;
    const MatchingContext context = take.context();
    const std::vector<Substring> substrings = take.substrings();
    Tables none(context, {.table_bytes = 0}), all(context, {});
    none.prepare(substrings);
    all.prepare(substrings);
    CHECK(none.bytes() == all.bytes());
    for (const Substring& one : substrings) REQUIRE(matches_of(none, one) == matches_of(all, one));
}

TEST_CASE("reach tables made by several threads at once are those made one by one") {
    const RandomTake take;
    const MatchingContext context = take.context();
    const std::vector<Substring> substrings = take.substrings();
    Tables together(context, {.threads = 2}), one_by_one(context, {});
    together.prepare(substrings);
    for (const Substring& one : substrings) {
        one_by_one.prepare({&one, 1});
        REQUIRE(matches_of(together, one) == matches_of(one_by_one, one));
    }
}
