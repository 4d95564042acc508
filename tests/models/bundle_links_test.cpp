#include "kinetome/models/bundle_links.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "kinetome/base/random.h"
#include "support/thread_ranks.h"

using namespace kinetome;

namespace {

constexpr int64_t cycle = 20;  // rows
constexpr int64_t clip_rows = 4 * cycle;

/// Which of three columns moves, and how: what two performers have in common.
struct Movement {
    int column = 0;
    double extent = 1;
};

/// Clips of cyclic movements, each with bundles cut at a phase of its own.
struct Performances {
    MatrixF rows;
    std::vector<RowRange> clips;
    std::vector<int32_t> subject_of;
    std::vector<BundleMember> members;

    /// A clip by each of two takes of the performer, two members in each, as one bundle.
    int32_t add(int32_t subject, Movement movement, double posture, int64_t phase) {
        const auto bundle = static_cast<int32_t>(clips.size() / 2);
        for (int take = 0; take < 2; ++take) {
            const int64_t first = rows.rows();
            rows.conservativeResize(first + clip_rows, 3);
            RandomStream random(1, "bundle links test", static_cast<uint64_t>(first));
            for (int64_t i = 0; i < clip_rows; ++i) {
                for (int column = 0; column < 3; ++column) {
                    const double angle = 2 * std::numbers::pi * double(i) / double(cycle);
                    const double moved = column == movement.column ? movement.extent : 0;
                    rows(first + i, column) = static_cast<float>(
                        posture + moved * (std::sin(angle) + 0.5 * std::sin(2 * angle)) +
                        0.02 * random.normal());
                }
            }
            const auto clip = static_cast<int32_t>(clips.size());
            clips.push_back({first, first + clip_rows});
            subject_of.push_back(subject);
            for (const int64_t of_cycle : {1, 2}) {
                const int64_t begin = of_cycle * cycle + phase;
                members.push_back({bundle, {clip, begin, begin + cycle / 2}});
            }
        }
        return bundle;
    }

    /// A bundle of one member of either extent.
    int32_t add_uneven(int32_t subject, double extent, double other) {
        const int32_t bundle = add(subject, {.extent = extent}, 0, 0);
        members.resize(members.size() - 3);
        add(subject, {.extent = other}, 0, 0);
        members.resize(members.size() - 3);
        members.back().bundle = bundle;
        return bundle;
    }

    /// Moves one column of some clips.
    void move(int column, float by, const std::vector<size_t>& of_clips) {
        for (const size_t clip : of_clips)
            rows.col(column).segment(clips[clip].first, clip_rows).array() += by;
    }

    BundleLinks link(const Workers& workers = 1, const BundleLinkOptions& options = {}) const {
        return link_bundles(rows, clips, members, subject_of, options, workers);
    }
};

using Pairs = std::set<std::pair<int32_t, int32_t>>;

Pairs pairs_of(const BundleLinks& links) {
    Pairs pairs;
    for (const BundleLink& link : links.links) pairs.emplace(link.first, link.second);
    return pairs;
}

}  // namespace

TEST_CASE("bundles of a cycle that two bodies cut at different phases are linked") {
    Performances performances;
    performances.add(0, {.column = 0}, 0, 0);
    performances.add(1, {.column = 0}, 0.01, 4);
    CHECK(pairs_of(performances.link()) == Pairs{{0, 1}});
}

TEST_CASE("bundles of opposite phases of a cycle are not linked") {
    Performances performances;
    performances.add(0, {.column = 0}, 0, 0);
    performances.add(1, {.column = 0}, 0.01, cycle / 2);
    CHECK(performances.link().links.empty());
}

TEST_CASE("movements of different limbs are not linked, however near they are") {
    // As a left and a right punch, which are as near as the same punch in another posture.
    Performances postures;
    postures.add(0, {.column = 0, .extent = 0.2}, 0, 0);
    postures.add(1, {.column = 0, .extent = 0.2}, 0.06, 0);
    CHECK(postures.link(1, {.reach = 10}).links.size() == 1);
    Performances limbs;
    limbs.add(0, {.column = 0, .extent = 0.1}, 0, 0);
    limbs.add(1, {.column = 1, .extent = 0.1}, 0, 0);
    CHECK(limbs.link(1, {.reach = 10}).links.empty());
}

TEST_CASE("what members of a bundle vary in hardly tells bodies apart") {
    for (const bool varied : {false, true}) {
        Performances performances;
        performances.add(0, {.column = 0}, 0, 0);
        performances.add(1, {.column = 0}, 0, 0);
        performances.move(2, 0.3, {2, 3});
        if (varied) performances.move(2, 0.3, {1});
        CHECK(performances.link().links.size() == (varied ? 1 : 0));
    }
}

TEST_CASE("a bundle is linked with the nearest of another body") {
    Performances performances;
    performances.add(0, {.extent = 1}, 0, 0);
    performances.add(1, {.extent = 1.1}, 0, 0);
    performances.add(1, {.extent = 1.02}, 0, 0);
    // The farther one has none nearer.
    const BundleLinks links = performances.link();
    CHECK(pairs_of(links) == Pairs{{0, 1}, {0, 2}});
    CHECK(links.kind_of == std::vector<int32_t>{0, 1, 1});
    CHECK(links.links.front().cost > links.links.back().cost);
    CHECK(links.links.front().cost < 1);
}

TEST_CASE("a bundle is not linked with what another kind of motion of its body resembles more") {
    Performances performances;
    performances.add(0, {.extent = 1}, 0, 0);
    performances.add(0, {.extent = 1.5}, 0, 0);
    performances.add(1, {.extent = 1.28}, 0, 0);
    const BundleLinks links = performances.link(1, {.reach = 10});
    CHECK(links.kind_of == std::vector<int32_t>{0, 1, 2});
    CHECK(pairs_of(links) == Pairs{{1, 2}});
    // One between both makes them one kind of motion.
    performances.add(0, {.extent = 1.25}, 0, 0);
    CHECK(pairs_of(performances.link(1, {.reach = 10})) == Pairs{{0, 2}, {1, 2}, {2, 3}});
}

TEST_CASE("a member that is in its bundle by mistake does not link it") {
    for (const bool mistaken : {false, true}) {
        Performances performances;
        performances.add(0, {.column = 0}, 0, 0);
        const int32_t mixed = performances.add(1, {.column = 1}, 0, 0);
        performances.add(1, {.column = 0}, 0, 0);
        // Three of the other movement and one of this, or the other way round.
        auto& members = performances.members;
        const std::ptrdiff_t others = mistaken ? 3 : 1;
        for (auto one = members.begin() + 8; one < members.end(); ++one) one->bundle = mixed;
        members.erase(members.begin() + 8 + (4 - others), members.end());
        members.erase(members.begin() + 4 + others, members.begin() + 8);
        CHECK(pairs_of(performances.link(1, {.members = 4})) ==
              (mistaken ? Pairs{} : Pairs{{0, 1}}));
    }
}

TEST_CASE("two that agree, but each with others of its own body, are not linked") {
    Performances performances;
    performances.add(0, {.extent = 1.16}, 0, 0);
    performances.add(1, {.extent = 1.44}, 0, 0);
    CHECK(pairs_of(performances.link(1, {.reach = 10})) == Pairs{{0, 1}});
    for (int i = 0; i < 2; ++i) performances.add(0, {.extent = 1}, 0, 0);
    for (int i = 0; i < 2; ++i) performances.add(1, {.extent = 1.6}, 0, 0);
    CHECK(pairs_of(performances.link(1, {.reach = 10})).empty());
    CHECK(pairs_of(performances.link(1, {.reach = 10, .company = 0})) == Pairs{{0, 1}});
}

TEST_CASE(
    "two that agree, but each with more other bodies, are not linked, whatever company tells") {
    Performances performances;
    performances.add(0, {.extent = 1.16}, 0, 0);
    performances.add(1, {.extent = 1.44}, 0, 0);
    for (const int32_t subject : {2, 3}) performances.add(subject, {.extent = 1}, 0, 0);
    for (const int32_t subject : {4, 5}) performances.add(subject, {.extent = 1.6}, 0, 0);
    CHECK(pairs_of(performances.link(1, {.reach = 10})) ==
          Pairs{{0, 2}, {0, 3}, {2, 3}, {1, 4}, {1, 5}, {4, 5}});
    CHECK(!pairs_of(performances.link(1, {.reach = 10, .company = 0})).contains({0, 1}));
}

TEST_CASE("two that agree are not linked where a third body has what is nearer to the one alone") {
    Performances performances;
    performances.add(0, {.extent = 1.16}, 0, 0);
    performances.add(1, {.extent = 1.44}, 0, 0);
    performances.add(2, {.extent = 1}, 0, 0);
    CHECK(pairs_of(performances.link(1, {.reach = 10})) == Pairs{{0, 2}});
    // One between them, of a body that speaks for both.
    performances.add(3, {.extent = 1.3}, 0, 0);
    CHECK(pairs_of(performances.link(1, {.reach = 10})).contains({0, 1}));
}

TEST_CASE("a third body that speaks for two and against them tells nothing") {
    for (const bool near_both : {false, true}) {
        Performances performances;
        performances.add(0, {.extent = 1.5}, 0, 0);
        performances.add(1, {.extent = 2.2}, 0, 0);
        performances.add(2, {.extent = 1.1}, 0, 0);  // against them: nearer to the first
        // By one member for them, though it agrees with neither.
        if (near_both)
            performances.add_uneven(2, 1.8, 5);
        else
            performances.add_uneven(2, 5, 8.2);
        CHECK(pairs_of(performances.link(1, {.reach = 10})).contains({0, 1}) == near_both);
    }
}

TEST_CASE("what few members make near is linked where its kind of motion is") {
    for (const bool with_kin : {false, true}) {
        Performances performances;
        performances.add(0, {.extent = 1}, 0, 0);
        // Only the one of its members is near to the other body's.
        const int32_t uneven = performances.add_uneven(1, 1.28, 2);
        if (with_kin) performances.add(1, {.extent = 1.4}, 0, 0);
        const BundleLinks links = performances.link(1, {.reach = 10});
        CHECK(pairs_of(links) == (with_kin ? Pairs{{0, 1}, {0, 3}} : Pairs{}));
        if (with_kin) CHECK(links.kind_of[3] == uneven);
        if (!with_kin) continue;
        // A third body that has the one, but nothing near the other.
        performances.add(2, {.extent = 0.6}, 0, 0);
        CHECK(pairs_of(performances.link(1, {.reach = 10})) == Pairs{{0, 3}});
    }
}

TEST_CASE("what agrees with a bundle of another body needs no kin") {
    Performances performances;
    performances.add(0, {.extent = 1}, 0, 0);
    performances.add_uneven(1, 1.28, 2);
    performances.add(1, {.extent = 1.4}, 0, 0);
    performances.add(2, {.extent = 1.6}, 0, 0);
    CHECK(pairs_of(performances.link(1, {.reach = 10})) == Pairs{{0, 3}, {0, 4}, {1, 4}, {3, 4}});
}

TEST_CASE("members at the ends of their takes are linked by what there is of their surroundings") {
    Performances performances;
    performances.add(0, {.column = 0}, 0, 0);
    performances.add(1, {.column = 0}, 0, 0);
    performances.members = {{0, {0, 0, 10}}, {0, {1, 60, 70}}, {1, {2, 20, 30}}, {1, {3, 40, 50}}};
    CHECK(performances.link().links.size() == 1);
}

TEST_CASE("movements in postures far apart are not linked") {
    Performances performances;
    performances.add(0, {.column = 0}, 0, 0);
    performances.add(1, {.column = 0}, 2, 0);
    CHECK(performances.link().links.empty());
}

TEST_CASE("bundles of one body are not linked with each other") {
    Performances performances;
    performances.add(0, {.column = 0}, 0, 0);
    performances.add(0, {.column = 0}, 0, 0);
    const BundleLinks links = performances.link();
    CHECK(links.usual_cost > 0);
    CHECK(links.kind_of == std::vector<int32_t>{0, 0});
    CHECK(links.links.empty());
}

TEST_CASE("links of bundles do not depend on threads, ranks or the order of members") {
    Performances performances;
    for (const int32_t subject : {0, 1, 2}) {
        performances.add(subject, {.column = 0}, 0.01 * subject, 3 * subject);
        performances.add(subject, {.column = 1}, 0.01 * subject, 2 * subject);
    }
    const BundleLinks links = performances.link();
    CHECK(links.links.size() == 6);
    CHECK(performances.link(3).links == links.links);
    for (const int count : {2, 5}) {
        run_as_ranks(count, [&](Communicator& ranks) {
            const BundleLinks shared = performances.link({1, &ranks});
            // Of all ranks, each in its own thread: checked by the test's alone.
            if (!(shared.links == links.links && shared.kind_of == links.kind_of))
                throw std::logic_error("a rank links other bundles");
        });
    }
    std::ranges::reverse(performances.members);
    CHECK(performances.link(2).links == links.links);
}

TEST_CASE("without two members of a bundle to compare nothing is linked") {
    Performances performances;
    performances.add(0, {.column = 0}, 0, 0);
    performances.add(1, {.column = 0}, 0, 0);
    performances.members = {performances.members[0], performances.members[4]};
    const BundleLinks links = performances.link();
    CHECK(links.usual_cost == 0);
    CHECK(links.links.empty());
}

TEST_CASE("links are refused for lists that disagree") {
    Performances performances;
    performances.add(0, {.column = 0}, 0, 0);
    Performances short_of_subjects = performances;
    short_of_subjects.subject_of.pop_back();
    CHECK_THROWS_AS(short_of_subjects.link(), std::invalid_argument);
    Performances beyond = performances;
    beyond.members.front().frames.end = clip_rows + 1;
    CHECK_THROWS_AS(beyond.link(), std::invalid_argument);
    Performances elsewhere = performances;
    elsewhere.members.front().frames.clip = 2;
    CHECK_THROWS_AS(elsewhere.link(), std::invalid_argument);
}
