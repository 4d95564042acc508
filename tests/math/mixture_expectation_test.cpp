// The E step against a plain double one, and the letters drawn from it.
#include <catch2/catch.hpp>
#include <limits>
#include <string>

#include "kinetome/math/mixture.h"
#include "mixture_reference.h"

using namespace kinetome;
using namespace kinetome::test;
using Catch::Matchers::Contains;

namespace {

void check_against_reference(const Mixture& model, const MatrixF& rows) {
    const MixtureSums expected = reference_sums(model, rows);
    const MixtureSums sums = accumulate(model, MatrixRows(rows), 1);
    CHECK(sums.rows == rows.rows());
    const double magnitude = std::max(std::abs(expected.mean_log_likelihood()), 1.0);
    CHECK(std::abs(sums.mean_log_likelihood() - expected.mean_log_likelihood()) <=
          1e-6 * magnitude);
    const auto dimension = double(rows.cols());
    for (int64_t k = 0; k < model.clusters(); ++k) {
        INFO("cluster " << k);
        // What is left out, 1e-7 a row, and what floats round.
        const double tolerance = 2e-6 * double(rows.rows()) + 2e-4 * expected.responsibility[k];
        CHECK(std::abs(sums.responsibility[k] - expected.responsibility[k]) <= tolerance);
        const double variance = model.variances[k];
        CHECK(std::abs(sums.squared[k] - expected.squared[k]) <=
              tolerance * 40 * dimension * variance + 2e-4 * expected.squared[k]);
        const double farthest_offset = (sums.offset.row(k) - expected.offset.row(k)).norm();
        CHECK(farthest_offset <= tolerance * 10 * std::sqrt(dimension * variance) +
                                     2e-4 * expected.offset.row(k).norm());
    }
}

}  // namespace

TEST_CASE("the E step equals a plain double one in every shape of tile, strip and group") {
    const auto [count, dimension, clusters] =
        GENERATE(table<int64_t, int64_t, int64_t>({{1, 1, 1},
                                                   {17, 1, 2},
                                                   {300, 3, 7},
                                                   {256, 15, 97},
                                                   {257, 15, 100},
                                                   {513, 8, 13},
                                                   {2500, 16, 6},
                                                   {5000, 2, 300},
                                                   {40, 62, 5}}));
    CAPTURE(count, dimension, clusters);
    const MatrixF rows = wandering_rows(count, dimension, 3);
    check_against_reference(random_mixture(rows, clusters, 0.2, 2, 4), rows);
}

TEST_CASE("the E step keeps its digits far from the origin") {
    MatrixF rows = wandering_rows(3000, 5, 5);
    rows.array() += 1e4F;
    check_against_reference(random_mixture(rows, 40, 0.05, 1, 6), rows);
}

TEST_CASE("the E step keeps its digits where variances differ by ten orders of magnitude") {
    const MatrixF rows = wandering_rows(3000, 4, 7);
    check_against_reference(random_mixture(rows, 40, 1e-3, 100, 8), rows);
}

TEST_CASE("the E step keeps its digits where rows next to each other are far apart") {
    MatrixF rows = scattered_rows(2000, 15, 9) * 30.0F;
    rows.array() -= 1e3F;
    check_against_reference(random_mixture(rows, 50, 0.03, 30, 10), rows);
}

TEST_CASE("rows far from every cluster have a likelihood, and belong to somebody") {
    MatrixF rows = wandering_rows(500, 6, 11);
    const Mixture model = random_mixture(rows, 20, 0.1, 0.2, 12);
    rows.array() += 300.0F;
    check_against_reference(model, rows);
}

TEST_CASE("products that a float cannot hold leave no row without a cluster") {
    MatrixF rows(40, 2);
    for (int64_t i = 0; i < rows.rows(); ++i) rows.row(i).setConstant(i < 20 ? -2e9F : 2e9F);
    Mixture model{MatrixD(2, 2), VectorD::Constant(2, 1e-26), VectorD::Constant(2, 0.5)};
    model.means.row(0).setConstant(-2e9);
    model.means.row(1).setConstant(2e9);
    const MixtureSums sums = accumulate(model, MatrixRows(rows), 1);
    CHECK(std::isfinite(sums.log_likelihood));
    CHECK(sums.responsibility[0] == Approx(20));
    CHECK(sums.responsibility[1] == Approx(20));
    CHECK(likeliest_clusters(model, MatrixRows(rows), 1).back() == 1);
}

TEST_CASE("the sums have the same bits on any number of threads") {
    const MatrixF rows = wandering_rows(20'000, 7, 13);
    const Mixture model = random_mixture(rows, 50, 0.2, 1, 14);
    const PieceLayout layout = layout_rows(rows.rows());
    REQUIRE(layout.pieces.size() > 7);
    const MixtureSums one = accumulate(model, MatrixRows(rows, layout), 1);
    for (const int threads : {2, 3, 7}) {
        CHECK(same_bits(one, accumulate(model, MatrixRows(rows, layout), threads)));
    }
}

TEST_CASE("sums of groups made apart and merged have the bits of those made together") {
    const MatrixF rows = wandering_rows(9000, 7, 15);
    const Mixture model = random_mixture(rows, 30, 0.2, 1, 16);
    const PieceLayout whole{{{0, 2500}, {2500, 4600}, {4600, 6700}, {6700, 9000}}, {0, 2, 4}};
    const PieceLayout first{{{0, 2500}, {2500, 4600}}, {0, 2}};
    const PieceLayout second{{{0, 2100}, {2100, 4400}}, {0, 2}};
    MixtureSums merged = accumulate(model, MatrixRows(rows.topRows(4600), first), 1);
    merge(merged, accumulate(model, MatrixRows(rows.bottomRows(4400), second), 2));
    CHECK(same_bits(merged, accumulate(model, MatrixRows(rows, whole), 2)));
}

TEST_CASE("another cutting of the rows gives the same model within rounding") {
    const MatrixF rows = wandering_rows(5000, 7, 17);
    const Mixture model = random_mixture(rows, 30, 0.2, 1, 18);
    MixtureSums halves = accumulate(model, MatrixRows(rows.topRows(1777)), 1);
    merge(halves, accumulate(model, MatrixRows(rows.bottomRows(3223)), 1));
    const Mixture a = estimate(model, halves, 1e-6);
    const Mixture b = estimate(model, accumulate(model, MatrixRows(rows), 1), 1e-6);
    CHECK((a.means - b.means).cwiseAbs().maxCoeff() < 1e-5);
    CHECK((a.variances - b.variances).cwiseAbs().maxCoeff() < 1e-5);
    CHECK((a.weights - b.weights).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("a value that is not finite is refused, naming its row") {
    MatrixF rows = wandering_rows(6000, 3, 19);
    const Mixture model = random_mixture(rows, 4, 0.2, 1, 20);
    const PieceLayout layout = layout_rows(rows.rows());
    rows(4321, 1) =
        GENERATE(std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity());
    CHECK_THROWS_WITH(accumulate(model, MatrixRows(rows, layout), 2),
                      Contains("row 4321, column 1"));
    CHECK_THROWS_WITH(likeliest_clusters(model, MatrixRows(rows), 2),
                      Contains("row 4321, column 1"));
    CHECK_THROWS_WITH(start_mixture(MatrixRows(rows, layout), 3, {}, 0, 1),
                      Contains("row 4321, column 1"));
    CHECK_THROWS_WITH(fit_mixture(MatrixRows(rows, layout), 3, {}, 1),
                      Contains("row 4321, column 1"));
}

TEST_CASE("models and rows that do not fit together are refused") {
    const MatrixF rows = wandering_rows(100, 3, 21);
    Mixture model = random_mixture(rows, 4, 0.2, 1, 22);
    CHECK_THROWS_AS(MatrixRows(rows, layout_rows(99)), std::invalid_argument);
    CHECK_THROWS_AS(accumulate(model, MatrixRows(rows.leftCols(2).eval()), 1),
                    std::invalid_argument);
    model.variances[2] = 0;
    CHECK_THROWS_WITH(accumulate(model, MatrixRows(rows), 1), Contains("cluster 2"));
}

TEST_CASE("no rows have sums of nothing") {
    const MatrixF rows(0, 3);
    const Mixture model{MatrixD::Zero(2, 3), VectorD::Ones(2), VectorD::Constant(2, 0.5)};
    const MixtureSums sums = accumulate(model, MatrixRows(rows), 2);
    CHECK(sums.rows == 0);
    CHECK(sums.responsibility == VectorD::Zero(2));
}

TEST_CASE("the likeliest cluster is that of the densities, whatever their weights") {
    const MatrixF rows = wandering_rows(1500, 5, 23);
    const Mixture model = random_mixture(rows, 60, 0.1, 2, 24);
    const std::vector<int32_t> letters = likeliest_clusters(model, MatrixRows(rows), 3);
    int64_t swayed_by_weight = 0;
    for (int64_t i = 0; i < rows.rows(); ++i) {
        int32_t best = 0, best_weighted = 0;
        for (int32_t k = 1; k < 60; ++k) {
            const double gain = log_density(model, k, rows, i) - log_density(model, best, rows, i);
            if (gain > 0) best = k;
            const double weighted_gain = log_density(model, k, rows, i) -
                                         log_density(model, best_weighted, rows, i) +
                                         std::log(model.weights[k] / model.weights[best_weighted]);
            if (weighted_gain > 0) best_weighted = k;
        }
        if (best != best_weighted) ++swayed_by_weight;
        REQUIRE(letters[size_t(i)] == best);
    }
    CHECK(swayed_by_weight > 0);
}

TEST_CASE("a row's letter does not depend on the rows it is drawn with") {
    const MatrixF rows = scattered_rows(1000, 5, 25);
    const Mixture model = random_mixture(rows, 60, 0.1, 2, 26);
    const std::vector<int32_t> together = likeliest_clusters(model, MatrixRows(rows), 2);
    for (int64_t i = 0; i < rows.rows(); i += 7) {
        CHECK(likeliest_clusters(model, MatrixRows(rows.middleRows(i, 1)), 1).front() ==
              together[size_t(i)]);
    }
}

TEST_CASE("of clusters that are equally likely the lowest is taken") {
    const MatrixF rows = MatrixF::Zero(20, 2);
    Mixture model{MatrixD::Zero(9, 2), VectorD::Ones(9), VectorD::Constant(9, 1.0 / 9)};
    model.means.row(0).setConstant(5);
    for (int64_t k = 1; k < 9; ++k) model.means(k, k % 2) = k < 5 ? 1 : -1;
    CHECK(likeliest_clusters(model, MatrixRows(rows), 1) == std::vector<int32_t>(20, 1));
}
