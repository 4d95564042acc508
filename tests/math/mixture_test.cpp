// Estimation and the whole fit.
#include "kinetome/math/mixture.h"

#include <atomic>
#include <catch2/catch.hpp>

#include "mixture_reference.h"

using namespace kinetome;
using namespace kinetome::test;

namespace {

/// Clusters of unit variance at known places ten apart, rows in the order of a random walk.
MatrixF rows_around(const MatrixD& centres, int64_t count) {
    RandomStream random(1, "rows around");
    MatrixF rows(count, centres.cols());
    int64_t at = 0;
    for (int64_t i = 0; i < count; ++i) {
        if (i % 10 == 0) at = static_cast<int64_t>(random.below(uint64_t(centres.rows())));
        for (int64_t j = 0; j < centres.cols(); ++j) {
            rows(i, j) = float(centres(at, j) + random.normal());
        }
    }
    return rows;
}

}  // namespace

TEST_CASE("clusters far apart are found where they are") {
    MatrixD centres(4, 3);
    centres << 0, 0, 0, 20, 0, 0, 0, 20, 5, 20, 20, -7;
    const MatrixF rows = rows_around(centres, 8000);
    const MixtureFit fit = fit_mixture(MatrixRows(rows), 4, {}, 2);
    CHECK(fit.converged);
    for (int64_t c = 0; c < 4; ++c) {
        int64_t nearest = 0;
        (fit.model.means.rowwise() - centres.row(c)).rowwise().squaredNorm().minCoeff(&nearest);
        CHECK((fit.model.means.row(nearest) - centres.row(c)).norm() < 0.15);
        CHECK(fit.model.variances[nearest] == Approx(1).margin(0.06));
    }
    CHECK(fit.model.weights.sum() == Approx(1));
}

TEST_CASE("one cluster is the mean and the mean variance of the rows") {
    const MatrixF rows = wandering_rows(3000, 3, 1);
    const Moments moments = moments_of(rows);
    const MixtureFit fit = fit_mixture(MatrixRows(rows), 1, {}, 1);
    CHECK((fit.model.means.row(0).transpose() - moments.mean).norm() < 1e-5);
    CHECK(fit.model.variances[0] == Approx(moments.scatter.trace() / 9000).epsilon(1e-5));
    CHECK(fit.model.weights[0] == 1);
}

TEST_CASE("the likelihood never falls from one iteration to the next") {
    const MatrixF rows = wandering_rows(6000, 4, 2);
    MixtureOptions options;
    options.min_gain = -1;
    options.max_iterations = 40;
    const MixtureFit fit = fit_mixture(MatrixRows(rows), 60, options, 2);
    REQUIRE(fit.history.size() == 40);
    CHECK_FALSE(fit.converged);
    for (size_t i = 1; i < fit.history.size(); ++i) {
        CHECK(fit.history[i] >= fit.history[i - 1] - 1e-6);
    }
    CHECK(fit.mean_log_likelihood >= fit.history.back() - 1e-6);
}

TEST_CASE("the likelihood reported is that of the model returned") {
    const MatrixF rows = wandering_rows(2000, 4, 3);
    MixtureOptions options;
    options.max_iterations = 3;
    const MixtureFit fit = fit_mixture(MatrixRows(rows), 20, options, 1);
    CHECK(fit.mean_log_likelihood ==
          Approx(reference_sums(fit.model, rows).mean_log_likelihood()).epsilon(1e-6));
    CHECK(fit.mean_log_likelihood > fit.history.back());
}

TEST_CASE("a fit has the same bits on any number of threads") {
    const MatrixF rows = wandering_rows(9000, 4, 4);
    MixtureOptions options;
    options.max_iterations = 5;
    const auto fit = [&](int threads) {
        return fit_mixture(MatrixRows(rows), 40, options, threads);
    };
    const MixtureFit one = fit(1);
    for (const int threads : {2, 3, 7}) {
        const MixtureFit other = fit(threads);
        CHECK(same_bits(one.model, other.model));
        CHECK(one.history == other.history);
        CHECK(one.mean_log_likelihood == other.mean_log_likelihood);
    }
}

TEST_CASE("a fit interrupted after any iteration goes on as if nothing had happened") {
    const MatrixF rows = wandering_rows(4100, 3, 5);
    const PieceLayout layout = layout_rows(4100);
    MixtureOptions options;
    options.max_iterations = 6;
    options.min_gain = 0.02;
    options.restarts = 3;
    int reports = 0;
    const MixtureFit whole = fit_mixture(MatrixRows(rows, layout), 30, options, 1, {},
                                         [&](const MixtureProgress&) { ++reports; });
    REQUIRE(reports > 6);
    for (int stop_after = 1; stop_after <= reports; ++stop_after) {
        std::atomic<bool> stop{false};
        MixtureProgress last;
        int seen = 0;
        const auto report = [&](const MixtureProgress& progress) {
            last = progress;
            stop = ++seen == stop_after;
        };
        CHECK_THROWS_AS(
            fit_mixture(MatrixRows(rows, layout), 30, options, 1, StopToken(stop), report),
            Interrupted);
        REQUIRE(seen == stop_after);
        const MixtureFit resumed =
            fit_mixture(MatrixRows(rows, layout), 30, options, 2, {}, {}, &last);
        CHECK(same_bits(resumed.model, whole.model));
        CHECK(resumed.history == whole.history);
        CHECK(resumed.mean_log_likelihood == whole.mean_log_likelihood);
        CHECK(resumed.converged == whole.converged);
    }
}

TEST_CASE("of several starts the likeliest is kept") {
    const MatrixF rows = wandering_rows(3000, 3, 6);
    const PieceLayout layout = layout_rows(3000);
    MixtureOptions options;
    options.max_iterations = 5;
    options.restarts = 4;
    std::vector<Mixture> ends(4);
    const MixtureFit fit = fit_mixture(
        MatrixRows(rows, layout), 12, options, 1, {}, [&](const MixtureProgress& progress) {
            ends[static_cast<size_t>(progress.restart)] = progress.model;
        });
    double best = -std::numeric_limits<double>::infinity();
    for (const Mixture& end : ends) {
        best = std::max(best, accumulate(end, MatrixRows(rows, layout), 1).mean_log_likelihood());
    }
    CHECK(fit.mean_log_likelihood == best);
    CHECK_FALSE(same_bits(ends[0], ends[1]));
}

TEST_CASE("a cluster without rows keeps its mean and weighs nothing") {
    MatrixF rows = wandering_rows(500, 3, 7);
    Mixture model = random_mixture(rows, 3, 0.5, 1, 8);
    model.means.row(1).setConstant(1e6);
    const PieceLayout layout = layout_rows(500);
    const MixtureSums sums = accumulate(model, MatrixRows(rows, layout), 1);
    REQUIRE(sums.responsibility[1] == 0);
    const Mixture next = estimate(model, sums, 0.01);
    CHECK(next.means.row(1) == model.means.row(1));
    CHECK(next.variances[1] == 0.01);
    CHECK(next.weights[1] > 0);
    CHECK(next.weights[1] < 1e-300);
    CHECK(std::isfinite(accumulate(next, MatrixRows(rows, layout), 1).log_likelihood));
}

TEST_CASE("no variance falls below its floor") {
    const MatrixF rows = wandering_rows(200, 3, 9);
    const Moments moments = moments_of(rows);
    MixtureOptions options;
    options.variance_floor = 0.01;
    const MixtureFit fit = fit_mixture(MatrixRows(rows), 150, options, 1);
    const double floor = 0.01 * moments.scatter.trace() / 200 / 3;
    CHECK(least_variance(moments, options) == Approx(floor));
    CHECK(fit.model.variances.minCoeff() == Approx(floor));
}

TEST_CASE("rows that are all equal make one cluster of finite likelihood") {
    const float value = GENERATE(0.0F, 1.0F, 12345.678F, -1e-12F);
    const MatrixF rows = MatrixF::Constant(100, 2, value);
    const MixtureFit fit = fit_mixture(MatrixRows(rows), 5, {}, 2);
    CHECK(fit.model.clusters() == 1);
    CHECK(fit.model.means(0, 0) == Approx(double(value)));
    CHECK(fit.model.variances[0] > 0);
    CHECK(std::isfinite(fit.mean_log_likelihood));
}

TEST_CASE("the information criterion charges every parameter") {
    MixtureFit fit;
    fit.model = {MatrixD::Zero(4, 3), VectorD::Ones(4), VectorD::Constant(4, 0.25)};
    fit.mean_log_likelihood = -2;
    CHECK(bayesian_information(fit, 100) == Approx(19 * std::log(100.0) + 400));
}
