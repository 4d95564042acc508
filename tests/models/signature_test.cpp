#include "kinetome/models/signature.h"

#include <catch2/catch.hpp>
#include <stdexcept>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

std::vector<int32_t> random_leaves(uint64_t seed, int64_t frames) {
    RandomStream random(seed, "leaves");
    std::vector<int32_t> leaves;
    while (static_cast<int64_t>(leaves.size()) < frames) {
        leaves.insert(leaves.end(), 1 + random.below(5), static_cast<int32_t>(random.below(4)));
    }
    leaves.resize(static_cast<size_t>(frames));
    return leaves;
}

}  // namespace

TEST_CASE("a signature collapses runs of a leaf and keeps where they are and how long") {
    const Signature signature = make_signature(std::vector<int32_t>{7, 7, 3, 7, 7, 7});
    CHECK(signature == Signature{{7, 0, 2}, {3, 2, 1}, {7, 3, 3}});
    CHECK(frame_count(signature) == 6);
    CHECK(make_signature({}).empty());
    CHECK(frame_count({}) == 0);
}

TEST_CASE("the run of a frame is the one that holds it") {
    const Signature signature = make_signature(std::vector<int32_t>{7, 7, 3, 7, 7, 7});
    std::vector<int64_t> runs;
    for (int64_t frame = 0; frame < 6; ++frame) runs.push_back(run_at(signature, frame));
    CHECK(runs == std::vector<int64_t>{0, 0, 1, 2, 2, 2});
}

TEST_CASE("a part of a signature is the signature of the part") {
    const auto leaves = random_leaves(3, 60);
    const Signature signature = make_signature(leaves);
    for (int64_t first = 0; first <= 60; ++first) {
        for (int64_t end = first; end <= 60; ++end) {
            const std::vector<int32_t> some(leaves.begin() + first, leaves.begin() + end);
            REQUIRE(part_of(signature, {first, end}) == make_signature(some));
        }
    }
    CHECK_THROWS_AS(part_of(signature, {0, 61}), std::out_of_range);
    CHECK_THROWS_AS(part_of(signature, {-1, 5}), std::out_of_range);
    CHECK_THROWS_AS(part_of(signature, {6, 5}), std::out_of_range);
}
