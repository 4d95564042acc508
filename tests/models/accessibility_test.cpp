#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "kinetome/models/pose_clusters.h"
#include "random_mixture.h"

using namespace kinetome;

TEST_CASE("Eq. 1 measures in the smaller of the two deviations, whichever letter comes first") {
    const Mixture mixture = mixture_on_line({0, 6, -2}, {3, 0.5, 1});
    CHECK(letter_distance(mixture, 0, 1) == Approx(12));
    CHECK(letter_distance(mixture, 1, 0) == Approx(12));
    CHECK(letter_distance(mixture, 0, 2) == Approx(2));
    CHECK(letter_distance(mixture, 2, 1) == Approx(16));
    CHECK(letter_distance(mixture, 1, 1) == 0);

    const Mixture many = random_mixture(40, 7, 3);
    for (int32_t a = 0; a < 40; ++a)
        for (int32_t b = 0; b < 40; ++b)
            REQUIRE(letter_distance(many, a, b) == letter_distance(many, b, a));
}

TEST_CASE("letters of no deviation are at no distance or out of reach, never at NaN") {
    const Mixture mixture = mixture_on_line({1, 1, 2}, {0, 0, 1});
    CHECK(letter_distance(mixture, 0, 1) == 0);
    CHECK(letter_distance(mixture, 0, 2) == std::numeric_limits<double>::infinity());
    const AccessibilityMatrix matrix = accessibility(mixture, 5, 1);
    CHECK(matrix(0, 1));
    CHECK_FALSE(matrix(0, 2));
}

TEST_CASE("accessibility is Eq. 2 for every pair, also where tau is just their distance") {
    const int64_t clusters = GENERATE(1, 2, 63, 64, 65, 128, 129, 300);
    const Mixture mixture = random_mixture(clusters, 6, static_cast<uint64_t>(clusters));
    const auto last = static_cast<int32_t>(clusters - 1);
    const double exact = letter_distance(mixture, last / 3, last);
    for (const double tau : {0.0, 0.5, 1.5, exact, std::nextafter(exact, 0.0), 1e9}) {
        CAPTURE(clusters, tau);
        const AccessibilityMatrix matrix = accessibility(mixture, tau, 1);
        int64_t ones = 0, mismatches = 0;
        for (int32_t a = 0; a < clusters; ++a) {
            for (int32_t b = 0; b < clusters; ++b) {
                const bool within = letter_distance(mixture, a, b) <= tau;
                ones += within;
                mismatches += matrix(a, b) != within;
            }
        }
        CHECK(mismatches == 0);
        CHECK(matrix.count() == ones);
        CHECK(matrix.letters() == clusters);
    }
}

TEST_CASE("accessibility does not depend on the number of threads") {
    const Mixture mixture = random_mixture(500, 9, 11);
    const AccessibilityMatrix one = accessibility(mixture, 2.5, 1);
    CHECK(one.count() > 1000);
    CHECK(accessibility(mixture, 2.5, 2) == one);
    CHECK(accessibility(mixture, 2.5, 7) == one);
}

TEST_CASE("a new accessibility matrix is the identity, and set is symmetric") {
    AccessibilityMatrix matrix(130);
    CHECK(matrix.words_per_row() == 3);
    CHECK(matrix.count() == 130);
    matrix.set(3, 129);
    CHECK(matrix(3, 129));
    CHECK(matrix(129, 3));
    CHECK(matrix.count() == 132);
    CHECK(matrix.words()[3 * 3 + 2] == uint64_t{1} << 1);
    CHECK(AccessibilityMatrix().count() == 0);
    CHECK(accessibility(Mixture{}, 1, 2).count() == 0);
}

TEST_CASE("an accessibility matrix is what its words were") {
    const AccessibilityMatrix matrix = accessibility(random_mixture(70, 3, 1), 2, 1);
    CHECK(AccessibilityMatrix(70, matrix.words()) == matrix);
    CHECK_THROWS_AS(AccessibilityMatrix(64, matrix.words()), std::invalid_argument);
}
