#include "kinetome/math/shifted_moments.h"

#include <catch2/catch.hpp>
#include <numeric>

#include "kinetome/base/random.h"

using namespace kinetome;

namespace {

/// Far from the origin, so that raw second moments would lose the variance.
MatrixF far_rows(int64_t rows, int64_t columns) {
    RandomStream random(9, "far_rows");
    MatrixF matrix(rows, columns);
    for (int64_t i = 0; i < rows; ++i) {
        for (int64_t j = 0; j < columns; ++j) {
            matrix(i, j) = static_cast<float>(1e4 + double(j) + random.normal());
        }
    }
    return matrix;
}

}  // namespace

TEST_CASE("shifted moments are those about the mean, for any number of rows and columns") {
    for (const int64_t columns : {1, 5, 8, 19}) {
        for (const int64_t rows : {1, 7, 33, 200}) {
            const MatrixF matrix = far_rows(rows, columns);
            std::vector<int32_t> half;
            for (int32_t i = 0; i < rows; i += 2) half.push_back(i);
            const VectorD point = VectorD::Constant(columns, 1e4);
            const Moments found = about_mean(shifted_moments(matrix, half, point), point);
            const Moments expected = moments_of(MatrixF(matrix(half, Eigen::all)));
            CHECK(found.count == expected.count);
            CHECK(found.mean.isApprox(expected.mean, 1e-12));
            CHECK((found.scatter - expected.scatter).norm() < 1e-7);
        }
    }
}

TEST_CASE("shifted moments of parts about one point add up") {
    const MatrixF matrix = far_rows(100, 6);
    std::vector<int32_t> all(100);
    std::iota(all.begin(), all.end(), 0);
    const VectorD point = matrix.row(0).cast<double>();
    ShiftedMoments sum = shifted_moments(matrix, std::span(all).first(30), point);
    merge(sum, shifted_moments(matrix, std::span(all).subspan(30), point));
    const Moments whole = about_mean(shifted_moments(matrix, all, point), point);
    CHECK(about_mean(sum, point).mean.isApprox(whole.mean, 1e-13));
    CHECK(about_mean(sum, point).scatter.isApprox(whole.scatter, 1e-10));
    const auto copy = unpacked<ShiftedMoments>(packed(sum));
    CHECK(packed(copy) == packed(sum));
    CHECK_THROWS_AS(about_mean({}, VectorD()), std::invalid_argument);
}
