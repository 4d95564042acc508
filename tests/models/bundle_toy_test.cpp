// S1 Figure 1: motions in the plane that share their middle, from points to bundles.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "kinetome/base/random.h"
#include "kinetome/models/motion_bundle.h"

using namespace kinetome;

namespace {

constexpr int families = 3;
constexpr int motions_per_family = 3;
constexpr int64_t frames_per_motion = 121;
constexpr double shared_half = 25;  ///< the middle that all families pass through, frames

/// Motions come from three sides, pass through one corridor, and part again: frame by frame one
/// unit along x, with a little noise across. Motion i is of family i % families.
MatrixF toy_points() {
    RandomStream random(4, "toy bundles");
    MatrixF points(families * motions_per_family * frames_per_motion, 2);
    Eigen::Index row = 0;
    for (int motion = 0; motion < families * motions_per_family; ++motion) {
        const double side = motion % families - 1;
        for (int64_t frame = 0; frame < frames_per_motion; ++frame, ++row) {
            const double x = static_cast<double>(frame - frames_per_motion / 2);
            const double y = side * 1.5 * std::max(0.0, std::abs(x) - shared_half);
            points(row, 0) = static_cast<float>(x + 0.1 * random.normal());
            points(row, 1) = static_cast<float>(y + 0.1 * random.normal());
        }
    }
    return points;
}

struct Toy {
    MotionString string;
    AccessibilityMatrix accessible;
    int64_t longest = 0;

    Toy() {
        const MatrixF points = toy_points();
        const MatrixRows rows(points);
        PoseClusterOptions options;
        options.clusters = 60;
        const Mixture mixture = fit_pose_clusters(rows, options, Workers{2, nullptr}).fit.model;
        const std::vector<int64_t> clips(families * motions_per_family, frames_per_motion);
        string = make_motion_string(likeliest_clusters(mixture, rows, Workers{2, nullptr}), clips);
        accessible = accessibility(mixture, adjacent_distance(string, mixture, 0.5), 2);
        longest = longest_substring(string, 200);
    }

    std::vector<SubstringBundle> bundles(const MotionBundleOptions& options) const {
        auto all = find_motion_bundles(string, accessible, longest, options);
        std::erase_if(all, [](const SubstringBundle& bundle) { return bundle.is_degenerate(); });
        return all;
    }
    int32_t motion_of(const Substring& member) const {
        return string.clip[static_cast<size_t>(member.first)];
    }
    std::set<int32_t> motions_in(const SubstringBundle& bundle) const {
        std::set<int32_t> motions;
        for (const Substring& member : bundle.members) motions.insert(motion_of(member));
        return motions;
    }
    /// The bundle's first member in that motion.
    Substring member_in(const SubstringBundle& bundle, int32_t motion) const {
        return *std::ranges::find(bundle.members, motion,
                                  [this](const Substring& member) { return motion_of(member); });
    }
    double frames_of(const Substring& member) const {
        return string.mean_frame(member.last) - string.mean_frame(member.first);
    }
};

}  // namespace

TEST_CASE("for long bundles the toy's motions come out whole, a bundle for each family") {
    const Toy toy;
    const auto spread = GENERATE(BundleSpread::depth, BundleSpread::closure);
    const auto bundles = toy.bundles({.rho = 2, .spread = spread});
    REQUIRE(bundles.size() == families);
    for (const SubstringBundle& bundle : bundles) {
        CHECK(bundle.height() == motions_per_family);
        const auto motions = toy.motions_in(bundle);
        CHECK(motions.size() == motions_per_family);
        for (const int32_t motion : motions)
            CHECK(motion % families == *motions.begin() % families);
        for (const Substring& member : bundle.members) {
            CHECK(toy.frames_of(member) > 0.9 * frames_per_motion);
        }
    }
}

TEST_CASE(
    "by the mean length of variants the toy's long motions come out in parts, families apart") {
    // What the default is the seed's length for; S1's Figure 1 shows them whole.
    const Toy toy;
    const auto bundles = toy.bundles(
        {.rho = 2, .spread = BundleSpread::closure, .member_length = MemberLength::mean});
    CHECK(bundles.size() > families);
    for (const SubstringBundle& bundle : bundles) {
        const auto motions = toy.motions_in(bundle);
        for (const int32_t motion : motions)
            CHECK(motion % families == *motions.begin() % families);
    }
}

TEST_CASE("for tall bundles the toy's motions come out in parts, the one they share together") {
    const Toy toy;
    const auto length = GENERATE(MemberLength::seed, MemberLength::mean);
    const auto bundles = toy.bundles({.rho = 1, .member_length = length});
    // What all share, and what each family has before and after it.
    REQUIRE(bundles.size() == 1 + 2 * families);
    CHECK(bundles[0].height() == families * motions_per_family);
    CHECK(toy.motions_in(bundles[0]).size() == families * motions_per_family);
    for (const Substring& member : bundles[0].members) {
        CHECK(toy.frames_of(member) == Approx(2 * shared_half).margin(5));
    }
    std::set<std::pair<int32_t, bool>> parts;
    for (size_t i = 1; i < bundles.size(); ++i) {
        CHECK(bundles[i].height() == motions_per_family);
        const auto motions = toy.motions_in(bundles[i]);
        CHECK(motions.size() == motions_per_family);
        for (const int32_t motion : motions)
            CHECK(motion % families == *motions.begin() % families);
        const bool before = bundles[i].members[0] < toy.member_in(bundles[0], *motions.begin());
        parts.emplace(*motions.begin() % families, before);
    }
    CHECK(parts.size() == 2 * families);
}
