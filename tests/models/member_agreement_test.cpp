#include "../../src/models/member_agreement.h"

#include <catch2/catch.hpp>

#include "kinetome/base/random.h"

using namespace kinetome;

TEST_CASE("bounds on how members agree are never above what they cost") {
    // Walks at random, so that some wander far apart and others meet.
    constexpr int64_t walks = 12, length = 60;
    MatrixF rows(walks * length, 5);
    std::vector<Occurrence> occurrences;
    RandomStream random(3, "member agreement test");
    for (int64_t walk = 0; walk < walks; ++walk) {
        const int64_t first = walk * length;
        for (int64_t i = 0; i < length; ++i) {
            for (int column = 0; column < 5; ++column) {
                const float before = i > 0 ? rows(first + i - 1, column) : 0;
                rows(first + i, column) = before + static_cast<float>(random.normal());
            }
        }
        occurrences.push_back({.member = {first + 25, first + 32},
                               .query = {first + 20, first + 38},
                               .sequence = {first, first + length}});
    }
    const MemberAgreement members(rows, occurrences, {.slip = length, .unlike = 10});
    constexpr double any = std::numeric_limits<double>::infinity();
    int bounded = 0;
    for (size_t a = 0; a < walks; ++a) {
        for (size_t b = 0; b < walks; ++b) {
            const double cost = members.find(a, b, any, any).cost;
            const double bound = members.bound(a, b, any);
            CHECK(bound <= cost);
            CHECK(bound >= 0.999 * cost);
            CHECK(members.bound(a, b, bound) == bound);
            if (bound > 0) CHECK(members.bound(a, b, 0.99 * bound) == any);
            CHECK(members.find(a, b, cost, any).cost == cost);
            CHECK((a != b || cost == 0));
            bounded += bound > 0;
        }
    }
    CHECK(bounded > walks);
}
