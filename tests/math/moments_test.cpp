#include "kinetome/math/moments.h"

#include <catch2/catch.hpp>
#include <limits>

#include "mixture_reference.h"

using namespace kinetome;
using namespace kinetome::test;

namespace {

/// In long double, the mean first.
Moments plain_moments(const MatrixF& rows) {
    const auto wide = rows.cast<long double>().eval();
    const auto mean = (wide.colwise().sum() / static_cast<long double>(rows.rows())).eval();
    const auto centred = (wide.rowwise() - mean).eval();
    return {rows.rows(), mean.transpose().cast<double>(),
            (centred.transpose() * centred).cast<double>()};
}

}  // namespace

TEST_CASE("moments keep their digits far from the origin") {
    const int64_t count = GENERATE(1, 2, 3, 4, 5, 4999);
    MatrixF rows = wandering_rows(count, 6, 1);
    rows.col(2).array() += 1e5F;
    rows.col(4).array() *= 1e-4F;
    const Moments expected = plain_moments(rows);
    const Moments whole = moments_of(rows);
    const Moments pieces = moments_of(MatrixRows(rows), 2);
    for (const Moments* moments : {&whole, &pieces}) {
        CHECK(moments->count == count);
        CHECK((moments->mean - expected.mean).cwiseAbs().maxCoeff() <= 1e-9);
        for (int64_t i = 0; i < 6; ++i) {
            for (int64_t j = 0; j < 6; ++j) {
                const double scale = std::sqrt(expected.scatter(i, i) * expected.scatter(j, j));
                CHECK(std::abs(moments->scatter(i, j) - expected.scatter(i, j)) <= 1e-9 * scale);
                CHECK(moments->scatter(i, j) == moments->scatter(j, i));
            }
        }
    }
}

TEST_CASE("moments have the same bits on any number of threads") {
    const MatrixF rows = wandering_rows(30'000, 9, 2);
    const Moments one = moments_of(MatrixRows(rows), 1);
    for (const int threads : {2, 3, 7}) {
        const Moments other = moments_of(MatrixRows(rows), threads);
        CHECK(other.mean == one.mean);
        CHECK(other.scatter == one.scatter);
    }
}

TEST_CASE("moments of a view have the bits of a copy") {
    const MatrixF rows = wandering_rows(500, 9, 3);
    const Moments view = moments_of(rows.block(3, 1, 400, 7));
    const MatrixF copy = rows.block(3, 1, 400, 7);
    CHECK(view.mean == moments_of(copy).mean);
    CHECK(view.scatter == moments_of(copy).scatter);
}

TEST_CASE("an empty side of a merge changes nothing") {
    const Moments some = moments_of(wandering_rows(10, 3, 4));
    Moments left = some, none, empty = moments_of(MatrixF(0, 3));
    merge(left, none);
    merge(left, empty);
    CHECK(left.scatter == some.scatter);
    merge(none, some);
    CHECK(none.scatter == some.scatter);
    CHECK(none.count == 10);
    CHECK(moments_of(MatrixRows(MatrixF(0, 3)), 2).count == 0);
}

TEST_CASE("moments of different columns are not added") {
    Moments left = moments_of(wandering_rows(10, 3, 5));
    CHECK_THROWS_AS(merge(left, moments_of(wandering_rows(10, 4, 5))), std::invalid_argument);
}
