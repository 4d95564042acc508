// The k-means++ start against plain D² sampling.
#include <catch2/catch.hpp>
#include <set>

#include "kinetome/math/mixture.h"
#include "mixture_reference.h"

using namespace kinetome;
using namespace kinetome::test;

namespace {

/// The same draws with every distance looked at: what the balls skip must not matter.
std::vector<int64_t> plain_start(const MatrixF& rows, int64_t clusters, uint64_t seed,
                                 uint64_t restart) {
    const auto draw = [&](int64_t j) {
        return RandomStream(seed, "k-means++", (restart << 32) + uint64_t(j));
    };
    std::vector<int64_t> chosen{static_cast<int64_t>(draw(0).below(uint64_t(rows.rows())))};
    VectorD nearest = VectorD::Constant(rows.rows(), std::numeric_limits<double>::infinity());
    for (int64_t j = 1; j < clusters; ++j) {
        for (int64_t i = 0; i < rows.rows(); ++i) {
            nearest[i] = std::min(nearest[i], squared_distance(rows, i, rows, chosen.back()));
        }
        double target = draw(j).uniform() * nearest.sum();
        int64_t row = 0;
        while (target >= nearest[row] && row + 1 < rows.rows()) target -= nearest[row++];
        chosen.push_back(row);
    }
    return chosen;
}

MatrixD rows_at(const MatrixF& rows, const std::vector<int64_t>& chosen) {
    MatrixD means(static_cast<int64_t>(chosen.size()), rows.cols());
    for (size_t k = 0; k < chosen.size(); ++k) {
        means.row(int64_t(k)) = rows.row(chosen[k]).cast<double>();
    }
    return means;
}

}  // namespace

TEST_CASE("the start draws the rows that sampling by plain distances draws") {
    const auto [count, clusters] =
        GENERATE(table<int64_t, int64_t>({{1, 1}, {15, 3}, {300, 20}, {5000, 150}, {9001, 60}}));
    const uint64_t seed = GENERATE(uint64_t{1}, uint64_t{77});
    const int restart = GENERATE(0, 2);
    const MatrixF rows = wandering_rows(count, 4, 1);
    MixtureOptions options;
    options.seed = seed;
    const Mixture start = start_mixture(MatrixRows(rows), clusters, options, restart, 1);
    CHECK(start.means == rows_at(rows, plain_start(rows, clusters, seed, uint64_t(restart))));
}

TEST_CASE("the start's variance is what is left of the rows about their nearest means") {
    const MatrixF rows = wandering_rows(3000, 3, 2);
    const Mixture start = start_mixture(MatrixRows(rows), 25, {}, 0, 1);
    double left = 0;
    for (int64_t i = 0; i < rows.rows(); ++i) {
        double nearest = std::numeric_limits<double>::infinity();
        for (int64_t k = 0; k < 25; ++k) {
            nearest = std::min(nearest, squared_distance(start, k, rows, i));
        }
        left += nearest;
    }
    CHECK(start.variances.minCoeff() == Approx(left / 9000));
    CHECK(start.variances.minCoeff() == start.variances.maxCoeff());
    CHECK(start.weights.minCoeff() == start.weights.maxCoeff());
}

TEST_CASE("the start has the same bits on any number of threads") {
    const MatrixF rows = wandering_rows(20'000, 5, 3);
    const PieceLayout layout = layout_rows(20'000);
    const Mixture one = start_mixture(MatrixRows(rows, layout), 80, {}, 0, 1);
    for (const int threads : {2, 3, 7}) {
        CHECK(same_bits(one, start_mixture(MatrixRows(rows, layout), 80, {}, 0, threads)));
    }
}

TEST_CASE("a start from a sample takes evenly spaced rows only") {
    MatrixF rows(1000, 1);
    for (int64_t i = 0; i < 1000; ++i) rows(i, 0) = float(i);
    MixtureOptions options;
    options.start_sample = 100;
    const Mixture start = start_mixture(MatrixRows(rows), 100, options, 0, 1);
    CHECK(start.clusters() == 100);
    for (int64_t k = 0; k < start.clusters(); ++k) CHECK(int64_t(start.means(k, 0)) % 10 == 0);
}

TEST_CASE("rows that coincide make one cluster, never two") {
    MatrixF rows(90, 2);
    for (int64_t i = 0; i < 90; ++i) rows.row(i) << float(i % 3), 1e4F;
    const Mixture start = start_mixture(MatrixRows(rows), 10, {}, 0, 1);
    CHECK(start.clusters() == 3);
    const VectorD column = start.means.col(0);
    CHECK(std::set<double>(column.begin(), column.end()) == std::set<double>{0, 1, 2});
    CHECK(start.variances[0] > 0);
}

TEST_CASE("a start is refused where there is nothing to start from") {
    const MatrixF rows = wandering_rows(5, 2, 4);
    CHECK_THROWS_AS(start_mixture(MatrixRows(rows), 6, {}, 0, 1), std::invalid_argument);
    CHECK_THROWS_AS(start_mixture(MatrixRows(rows), 0, {}, 0, 1), std::invalid_argument);
    MatrixF distant(2, 1);
    distant << -1e30F, 1e30F;
    CHECK_THROWS_AS(start_mixture(MatrixRows(distant), 1, {}, 0, 1), std::invalid_argument);
}
