#include "kinetome/models/motion_bundle.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "bundle_reference.h"
#include "kinetome/base/random.h"
#include "random_mixture.h"
#include "support/thread_ranks.h"

using namespace kinetome;

namespace {

/// A string of random letters and frames, broken into clips, and letters at random accessible.
struct RandomCase {
    MotionString string;
    AccessibilityMatrix accessibility;
    int64_t longest = 2;
    MotionBundleOptions options;
};

RandomCase random_case(uint64_t number, uint64_t most_runs = 13) {
    RandomStream random(number, "random motion string");
    const auto letters = static_cast<int32_t>(2 + random.below(5));
    std::vector<int32_t> frame_letters;
    std::vector<int64_t> clip_frames;
    const uint64_t clips = 1 + random.below(3);
    for (uint64_t clip = 0; clip < clips; ++clip) {
        const auto runs = static_cast<int64_t>(random.below(most_runs + 1));
        clip_frames.push_back(0);
        for (int64_t run = 0; run < runs; ++run) {
            const auto letter = static_cast<int32_t>(random.below(static_cast<uint64_t>(letters)));
            const auto frames = static_cast<int64_t>(1 + random.below(4));
            frame_letters.insert(frame_letters.end(), static_cast<size_t>(frames), letter);
            clip_frames.back() += frames;
        }
    }
    RandomCase made{make_motion_string(frame_letters, clip_frames),
                    AccessibilityMatrix(letters),
                    static_cast<int64_t>(2 + random.below(5)),
                    {}};
    const double density = random.below(2) == 0 ? 0.15 : 0.6;
    for (int32_t a = 0; a < letters; ++a) {
        for (int32_t b = a + 1; b < letters; ++b) {
            if (random.uniform() < density) made.accessibility.set(a, b);
        }
    }
    constexpr std::array spreads = {"closure", "closure-near", "closure-length",
                                    "depth:1", "depth:2",      "depth:3"};
    parse_spread(spreads[random.below(spreads.size())], made.options);
    if (random.below(3) == 0) made.options.member_length = MemberLength::mean;
    made.options.rho = random.below(2) == 0 ? 1 : 2;
    made.options.gamma = random.below(3) == 0 ? 0 : 0.8;
    made.options.seed = number;
    return made;
}

}  // namespace

TEST_CASE("bundles are those that S1 defines, searched without any shortcut") {
    int64_t several = 0;
    for (uint64_t number = 0; number < 3000; ++number) {
        const RandomCase one = random_case(number);
        const auto found =
            find_motion_bundles(one.string, one.accessibility, one.longest, one.options);
        INFO("case " << number << ", " << spread_text(one.options) << ", member length "
                     << int(one.options.member_length));
        REQUIRE(found ==
                reference::motion_bundles(one.string, one.accessibility, one.longest, one.options));
        for (const SubstringBundle& bundle : found) several += !bundle.is_degenerate();
    }
    CHECK(several > 3000);  // the cases are not empty ones
}

TEST_CASE("every interval inside a clip is in one bundle, and none across a break") {
    for (uint64_t number = 0; number < 200; ++number) {
        const RandomCase one = random_case(number);
        std::vector<int> covered(static_cast<size_t>(one.string.size()));
        for (const SubstringBundle& bundle :
             find_motion_bundles(one.string, one.accessibility, one.longest, one.options)) {
            for (const Substring& member : bundle.members) {
                for (int32_t j = member.first; j < member.last; ++j)
                    ++covered[static_cast<size_t>(j)];
            }
        }
        for (int64_t j = 0; j < one.string.size(); ++j) {
            CHECK(covered[static_cast<size_t>(j)] == (one.string.breaks_after(j) ? 0 : 1));
        }
    }
}

TEST_CASE("bundles do not depend on threads, ranks or the memory for reach tables") {
    constexpr uint64_t enough_for_threads_and_ranks = 200;  // letters a clip, at most
    for (uint64_t number = 0; number < 60; ++number) {
        const RandomCase one = random_case(number, enough_for_threads_and_ranks);
        const auto found = [&](const BundleResources& resources) {
            return find_motion_bundles(one.string, one.accessibility, one.longest, one.options,
                                       resources);
        };
        const auto alone = found({});
        CHECK(alone == found({.threads = 2, .table_bytes = 0}));
        run_as_ranks(2 + static_cast<int>(number % 2), [&](Communicator& ranks) {
            if (found({.ranks = &ranks, .least_shared = 2}) != alone)
                throw std::logic_error("a rank finds other bundles");
        });
    }
}

TEST_CASE("a limit on substrings that no clip reaches changes nothing, at any width of masks") {
    for (uint64_t number = 0; number < 100; ++number) {
        const RandomCase one = random_case(number);
        const auto found = [&](int64_t longest) {
            return find_motion_bundles(one.string, one.accessibility, longest, one.options);
        };
        const auto wanted = found(14);
        for (const int64_t longest : {33, 70, 200, 5000}) CHECK(found(longest) == wanted);
    }
}

TEST_CASE("two equal takes are one bundle as long as they are, up to what can be matched") {
    for (const int32_t length : {30, 60, 130, 250}) {
        std::vector<int32_t> letters;
        for (int take = 0; take < 2; ++take) {
            for (int32_t letter = 0; letter < length; ++letter) letters.push_back(letter);
        }
        const MotionString string =
            make_motion_string(letters, std::vector<int64_t>{length, length});
        const auto bundles = find_motion_bundles(string, AccessibilityMatrix(length), length, {});
        REQUIRE(bundles.size() == 1);
        CHECK(bundles[0].members ==
              std::vector<Substring>{{0, length - 1}, {length, 2 * length - 1}});
    }
}

TEST_CASE("spreads are named as they are read, and nothing else is read") {
    MotionBundleOptions options;
    for (const std::string text : {"closure", "closure-near", "closure-length", "depth:7"}) {
        parse_spread(text, options);
        CHECK(spread_text(options) == text);
    }
    for (const std::string text : {"", "depth", "depth:", "depth:0", "depth:-1", "depth:2x", "far"})
        CHECK_THROWS_AS(parse_spread(text, options), std::invalid_argument);
}

TEST_CASE("letters of large variance are near only where their means are") {
    // d(0, 1) = 1, d(1, 2) = 9, d(0, 2) = 10: τ is the median, 9.
    const Mixture mixture = mixture_on_line({0, 1, 10}, {1, 1, 1});
    const MotionString string =
        make_motion_string(std::vector<int32_t>{0, 1, 2, 1}, std::vector<int64_t>{4});
    CHECK(adjacent_step(string, mixture, 0.5) == 9);
    const AccessibilityMatrix all = accessibility(mixture, 100, 1);
    const AccessibilityMatrix near = within_step(all, mixture, 9);
    CHECK(all.count() == 9);
    CHECK((near(0, 1) && near(1, 0) && near(1, 2) && near(1, 1)));
    CHECK_FALSE(near(0, 2));
    CHECK(within_step(AccessibilityMatrix(3), mixture, 9) == AccessibilityMatrix(3));
}

TEST_CASE("what bundles are sought among is limited by the steps asked for, closure-near to half") {
    // Steps of 1, 2, 4, 8: their quartiles.
    const Mixture mixture = mixture_on_line({0, 1, 3, 7, 15}, {1, 1, 1, 1, 1});
    const MotionString string =
        make_motion_string(std::vector<int32_t>{0, 1, 2, 3, 4}, std::vector<int64_t>{5});
    const AccessibilityMatrix all = accessibility(mixture, 100, 1);
    const auto sought = [&](const MotionBundleOptions& options) {
        return accessibility_for_bundles(all, string, mixture, options);
    };
    CHECK(sought({.step_quantile = 1}) == all);
    CHECK(sought({.step_quantile = 0.7}) == within_step(all, mixture, 4));
    CHECK(sought({.spread = BundleSpread::closure_near, .step_quantile = 1}) ==
          within_step(all, mixture, 2));
    CHECK(sought({.spread = BundleSpread::closure_near, .step_quantile = 0.1}) ==
          within_step(all, mixture, 1));
}

TEST_CASE("options of no meaning are refused") {
    const MotionString string =
        make_motion_string(std::vector<int32_t>{0, 1, 0, 1}, std::vector<int64_t>{4});
    const auto find = [&](MotionBundleOptions options, int64_t longest, int64_t letters) {
        return find_motion_bundles(string, AccessibilityMatrix(letters), longest, options);
    };
    CHECK_NOTHROW(find({}, 2, 2));
    CHECK_THROWS_AS(find({}, 1, 2), std::invalid_argument);
    CHECK_THROWS_AS(find({}, 2, 1), std::invalid_argument);
    CHECK_THROWS_AS(find({.rho = 0}, 2, 2), std::invalid_argument);
    CHECK_THROWS_AS(find({.gamma = 1.5}, 2, 2), std::invalid_argument);
    CHECK_THROWS_AS(find({.depth = 0}, 2, 2), std::invalid_argument);
    CHECK(find_motion_bundles({}, AccessibilityMatrix(), 2, {}).empty());
}
