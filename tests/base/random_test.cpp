#include "kinetome/base/random.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

#include "kinetome/base/digest.h"

using namespace kinetome;

namespace {

using Words = std::array<uint32_t, 4>;

std::vector<uint64_t> draws(RandomStream random, int count) {
    std::vector<uint64_t> values;
    for (int i = 0; i < count; ++i) values.push_back(random());
    return values;
}

/// |observed - expected| in standard deviations of a count of independent events.
double deviations(double observed, double trials, double probability) {
    return std::abs(observed - trials * probability) /
           std::sqrt(trials * probability * (1 - probability));
}

}  // namespace

TEST_CASE("Philox gives the known answers of its authors' test vectors") {
    CHECK(philox({0, 0, 0, 0}, {0, 0}) == Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
    CHECK(philox({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}) ==
          Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
    CHECK(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
          Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("what a stream draws does not depend on what other streams drew before or between") {
    const auto alone = draws(RandomStream(7, "em", 3), 9);
    RandomStream other(7, "em", 2), same(7, "em", 3);
    for (const uint64_t value : alone) {
        for (int i = 0; i < 5; ++i) other();
        CHECK(same() == value);
    }
}

TEST_CASE("streams that differ in seed, stage or item share no draws") {
    std::set<uint64_t> values;
    size_t drawn = 0;
    for (const uint64_t seed : {0, 1}) {
        for (const char* stage : {"em", "hierarchy", ""}) {
            for (const uint64_t item : {uint64_t{0}, uint64_t{1}, uint64_t{1} << 32}) {
                for (const uint64_t value : draws(RandomStream(seed, stage, item), 100)) {
                    values.insert(value);
                    ++drawn;
                }
            }
        }
    }
    CHECK(values.size() == drawn);
}

TEST_CASE("the bits of a stream never change: a rebuilt index would differ from the last one") {
    CHECK(draws(RandomStream(2026, "pose clusters", 5), 3) ==
          std::vector<uint64_t>{0x80278149a745db05, 0x62e73e39b7a58a7f, 0x291cede1327e0b30});
}

TEST_CASE("a stream is Philox at (block, item) under the key of seed and stage") {
    const uint64_t key = Hasher().number(7).text("em").finish().low;
    std::vector<uint64_t> expected;
    for (const uint32_t block : {0, 1}) {
        const Words words = philox({block, 0, 5, 9}, {uint32_t(key), uint32_t(key >> 32)});
        expected.push_back((uint64_t{words[1]} << 32) | words[0]);
        expected.push_back((uint64_t{words[3]} << 32) | words[2]);
    }
    CHECK(draws(RandomStream(7, "em", (uint64_t{9} << 32) | 5), 4) == expected);
}

TEST_CASE("uniform draws fill the unit interval evenly") {
    constexpr int count = 200'000, bins = 50;
    RandomStream random(1, "uniform");
    std::vector<int> histogram(bins);
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        const double value = random.uniform();
        REQUIRE((value >= 0 && value < 1));
        sum += value;
        ++histogram[static_cast<size_t>(value * bins)];
    }
    CHECK(std::abs(sum / count - 0.5) < 5 / std::sqrt(12.0 * count));
    double chi_square = 0;
    for (const int observed : histogram) {
        chi_square += std::pow(observed - count / bins, 2) / (count / bins);
    }
    CHECK(chi_square < 49 + 5 * std::sqrt(2 * 49.0));
}

TEST_CASE("normal draws have the moments of a standard normal and do not repeat in pairs") {
    constexpr int count = 200'000;
    RandomStream random(1, "normal");
    double sum = 0, square = 0, cube = 0, fourth = 0, neighbours = 0, last = 0;
    for (int i = 0; i < count; ++i) {
        const double x = random.normal();
        sum += x;
        square += x * x;
        cube += x * x * x;
        fourth += x * x * x * x;
        neighbours += x * last;
        last = x;
    }
    // Five standard deviations of each mean: the variances of x, x², x³, x⁴ are 1, 2, 15, 96.
    const double scale = 5 / std::sqrt(double(count));
    CHECK(std::abs(sum / count) < scale);
    CHECK(std::abs(square / count - 1) < scale * std::sqrt(2.0));
    CHECK(std::abs(cube / count) < scale * std::sqrt(15.0));
    CHECK(std::abs(fourth / count - 3) < scale * std::sqrt(96.0));
    CHECK(std::abs(neighbours / count) < scale);
}

TEST_CASE("below() favours no result even where 2^64 is far from a multiple of the bound") {
    // A plain remainder makes the first third one and a half times as likely; a plain product
    // makes the multiples of three twice as likely as the others.
    constexpr uint64_t third = uint64_t{1} << 62, bound = 3 * third;
    constexpr int count = 30'000;
    RandomStream random(1, "below");
    std::array<int, 3> thirds{}, remainders{};
    for (int i = 0; i < count; ++i) {
        const uint64_t value = random.below(bound);
        REQUIRE(value < bound);
        ++thirds[value / third];
        ++remainders[value % 3];
    }
    for (size_t i = 0; i < 3; ++i) {
        CHECK(deviations(thirds[i], count, 1.0 / 3) < 5);
        CHECK(deviations(remainders[i], count, 1.0 / 3) < 5);
    }
}

TEST_CASE("below() reaches every result of a small bound and never the bound") {
    RandomStream random(1, "small");
    std::array<int, 6> faces{};
    for (int i = 0; i < 60'000; ++i) ++faces.at(random.below(6));
    for (const int face : faces) CHECK(deviations(face, 60'000, 1.0 / 6) < 5);
    for (int i = 0; i < 10; ++i) CHECK(random.below(1) == 0);
}
