#include "kinetome/math/pca.h"

#include <catch2/catch.hpp>

#include "mixture_reference.h"

using namespace kinetome;
using namespace kinetome::test;

namespace {

/// Moments whose standardised covariance has the given eigenvalues and eigenvectors, when these
/// make a unit diagonal: exact, no sampling.
Moments moments_with(const MatrixD& covariance) {
    return {101, VectorD::Zero(covariance.rows()), covariance * 100};
}

VectorD floor_of(int64_t dimension, double value = 1e-9) {
    return VectorD::Constant(dimension, value);
}

}  // namespace

TEST_CASE("components are those of a covariance that is known") {
    MatrixD covariance(2, 2);
    covariance << 4, 3, 3, 9;  // correlation 1/2: eigenvalues 3/2 and 1/2 along the diagonals
    const Pca pca = fit_pca(moments_with(covariance), floor_of(2), 1.0);
    CHECK(pca.scale[0] == Approx(2));
    CHECK(pca.scale[1] == Approx(3));
    REQUIRE(pca.dimension() == 2);
    CHECK(pca.variances[0] == Approx(1.5));
    CHECK(pca.variances[1] == Approx(0.5));
    CHECK(pca.components(0, 0) == Approx(std::sqrt(0.5)));
    CHECK(pca.components(1, 0) == Approx(std::sqrt(0.5)));
    CHECK(pca.components(0, 1) == Approx(-pca.components(1, 1)));
}

TEST_CASE("the fewest components that hold the share are kept") {
    // Features below the floor are scaled by it alone, so that the eigenvalues are chosen freely.
    const MatrixD covariance = VectorD(Eigen::Vector4d(6, 3, 1, 0)).asDiagonal();
    const auto kept = [&](double share) {
        return fit_pca(moments_with(covariance), floor_of(4, 10), share).dimension();
    };
    CHECK(kept(1e-9) == 1);
    CHECK(kept(0.59) == 1);
    CHECK(kept(0.61) == 2);
    CHECK(kept(0.89) == 2);
    CHECK(kept(0.91) == 3);
    CHECK(kept(1.0) == 3);
    const Pca pca = fit_pca(moments_with(covariance), floor_of(4, 10), 0.7);
    CHECK(pca.kept_share() == Approx(0.9));
    CHECK(pca.variances.size() == 4);
}

TEST_CASE("features that hardly move are not blown up") {
    MatrixF rows = wandering_rows(2000, 3, 1);
    rows.col(1) *= 1e-6F;
    const Pca pca = fit_pca(moments_of(rows), floor_of(3, 0.01), 1.0);
    CHECK(pca.scale[1] == 0.01);
    CHECK(pca.variances[2] < 1e-6);
}

TEST_CASE("projected rows are uncorrelated and have the variances of the components") {
    MatrixF rows = wandering_rows(3000, 5, 2);
    rows.col(3) = rows.col(0) * 2.0F + rows.col(1);
    rows.array() += 100.0F;
    const Pca pca = fit_pca(moments_of(rows), floor_of(5), 0.99);
    const Moments projected = moments_of(pca.project(rows));
    CHECK((pca.components.transpose() * pca.components -
           MatrixD::Identity(pca.dimension(), pca.dimension()))
              .cwiseAbs()
              .maxCoeff() < 1e-12);
    for (int64_t i = 0; i < pca.dimension(); ++i) {
        CHECK(projected.mean[i] == Approx(0).margin(1e-5));
        for (int64_t j = 0; j < pca.dimension(); ++j) {
            const double expected = i == j ? pca.variances[i] : 0.0;
            CHECK(projected.scatter(i, j) / 2999 == Approx(expected).margin(1e-5));
        }
    }
}

TEST_CASE("a row's projection does not depend on the rows beside it") {
    const MatrixF rows = wandering_rows(100, 7, 3);
    const Pca pca = fit_pca(moments_of(rows), floor_of(7), 0.9);
    const MatrixF all = pca.project(rows);
    for (int64_t i = 0; i < 100; i += 9) CHECK(pca.project(rows.middleRows(i, 1)) == all.row(i));
}

TEST_CASE("the largest entry of every component is positive") {
    const Pca pca = fit_pca(moments_of(wandering_rows(400, 12, 4)), floor_of(12), 1.0);
    for (int64_t k = 0; k < pca.dimension(); ++k) {
        int64_t largest = 0;
        pca.components.col(k).cwiseAbs().maxCoeff(&largest);
        CHECK(pca.components(largest, k) > 0);
    }
}

TEST_CASE("rows without any variance keep one component") {
    const Pca pca = fit_pca(moments_of(MatrixF::Constant(5, 3, 2.0F)), floor_of(3, 0.1), 0.7);
    CHECK(pca.dimension() == 1);
    CHECK(pca.kept_share() == 1);
    CHECK(pca.project(MatrixF::Constant(1, 3, 2.0F))(0, 0) == 0);
}

TEST_CASE("components that cannot be found are refused") {
    const Moments moments = moments_of(wandering_rows(10, 3, 5));
    CHECK_THROWS_AS(fit_pca(moments_of(wandering_rows(1, 3, 5)), floor_of(3), 0.7),
                    std::invalid_argument);
    CHECK_THROWS_AS(fit_pca(moments, floor_of(2), 0.7), std::invalid_argument);
    CHECK_THROWS_AS(fit_pca(moments, floor_of(3, 0), 0.7), std::invalid_argument);
    CHECK_THROWS_AS(fit_pca(moments, floor_of(3), 0), std::invalid_argument);
    CHECK_THROWS_AS(fit_pca(moments, floor_of(3), 1.01), std::invalid_argument);
    MatrixF rows = wandering_rows(10, 3, 5);
    rows(4, 1) = std::numeric_limits<float>::quiet_NaN();
    CHECK_THROWS_AS(fit_pca(moments_of(rows), floor_of(3), 0.7), std::invalid_argument);
}
