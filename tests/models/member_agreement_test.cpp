#include "../../src/models/member_agreement.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

MatrixF random_rows(uint64_t seed, int64_t count, int64_t columns) {
    RandomStream random(seed, "member agreement test");
    MatrixF rows(count, columns);
    for (Eigen::Index i = 0; i < rows.size(); ++i)
        rows.data()[i] = static_cast<float>(random.normal());
    return rows;
}

/// Every path, cell after cell.
struct EveryPath {
    const MatrixF& rows;
    int64_t first, end;  ///< of the one's surroundings
    RowRange clip;       ///< of the other
    double distance(int64_t one, int64_t other) const {
        return static_cast<double>((rows.row(one) - rows.row(other)).norm());
    }
    /// What the cheapest path costs outwards from there, the cell itself counted.
    double outwards(int64_t one, int64_t other, int64_t by) const {
        const int64_t left = by > 0 ? end - 1 - one : one - first;
        const double here = distance(one, other);
        if (left == 0) return here;
        double least = infinite;
        const auto go_on = [&](int64_t rows_on, int64_t others_on, double weight) {
            const int64_t there = other + by * others_on;
            if (rows_on > left || there < clip.first || there >= clip.end) return;
            least = std::min(least, weight * here + outwards(one + by * rows_on, there, by));
        };
        go_on(1, 1, 1);
        go_on(1, 2, 1);
        go_on(2, 1, 2);
        return least;
    }
};

}  // namespace

TEST_CASE("no path through the middles of two members is cheaper than the one that is found") {
    constexpr BundleLinkOptions options{.surroundings = 11, .slip = 1};
    int found = 0;
    for (uint64_t seed = 0; seed < 40; ++seed) {
        const MatrixF rows = random_rows(seed, 40, 3);
        const RowRange one_clip{0, 20}, other_clip{20, 40};
        RandomStream random(seed, "member agreement test places");
        const auto at = static_cast<int64_t>(random.below(18));
        const auto there = 20 + static_cast<int64_t>(random.below(18));
        const Occurrence one{{at, at + 3}, one_clip}, other{{there, there + 3}, other_clip};
        const MemberAgreement members(rows, {one, other}, options);
        const Agreement agreement = members.find(0, 1, infinite);
        // Surroundings lie in both clips alike: five rows to each side, or more on the other.
        const int64_t before = std::min(at + 1, there - 20 + 1),
                      after = 18 - std::max(at, there - 20);
        int64_t left = std::min<int64_t>(before, 5);
        const int64_t right = std::min(after, 10 - left);
        left = std::min(before, 10 - right);
        const double count = double(left + 1 + right);
        double least = infinite, least_after = infinite, least_before = infinite;
        if (count >= 0.6 * 11) {
            const EveryPath every{rows, one.middle() - left, one.middle() + right + 1, other_clip};
            const int64_t end = std::min<int64_t>(40, there + 4);
            for (int64_t row = std::max<int64_t>(20, there - 1); row < end; ++row) {
                const double onward = every.outwards(one.middle(), row, 1);
                const double backward = every.outwards(one.middle(), row, -1);
                least = std::min(least, onward + backward - every.distance(one.middle(), row));
                least_after = std::min(least_after, onward / double(right + 1));
                least_before = std::min(least_before, backward / double(left + 1));
            }
        }
        if (least == infinite) {
            CHECK(agreement.cost == infinite);
            continue;
        }
        ++found;
        CHECK(agreement.cost == Approx(least / count).epsilon(1e-5));
        CHECK(agreement.unlikeness > 0);
        CHECK(agreement.unlikeness < 1.3);
        // Giving up early loses no path that is cheap enough, on either side of the middle.
        const double enough = std::max({agreement.cost, least_after, least_before});
        CHECK(members.find(0, 1, enough * 1.0001).cost == agreement.cost);
        CHECK(members.find(0, 1, std::max(least_after, least_before) * 0.9999).cost == infinite);
        CHECK(members.find(0, 1, agreement.cost * 0.9999).cost == infinite);
    }
    CHECK(found > 20);
}

TEST_CASE("a movement is like itself in another posture, and unlike its reverse") {
    const MatrixF part = random_rows(1, 15, 4);
    MatrixF rows(45, 4);
    rows << part, part.array() + 1, -part;
    const auto member = [](int64_t first) {
        return Occurrence{{first + 6, first + 9}, {first, first + 15}};
    };
    const MemberAgreement members(rows, {member(0), member(15), member(30)},
                                  {.surroundings = 15, .slip = 0});
    CHECK(members.find(0, 0, infinite).cost == 0);
    CHECK(members.find(0, 0, infinite).unlikeness == 0);
    CHECK(members.find(0, 1, infinite).unlikeness < 0.7);
    CHECK(members.find(0, 2, infinite).unlikeness > 0.8);
}
