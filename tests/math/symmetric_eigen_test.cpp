#include "kinetome/math/symmetric_eigen.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace kinetome;

TEST_CASE("eigenvalues come largest first, each with its vector") {
    MatrixD matrix(3, 3);
    matrix << 2, 1, 0, 1, 2, 0, 0, 0, -5;  // 3 along (1, 1, 0), 1 along (1, -1, 0), -5 along z
    const SymmetricEigen eigen = symmetric_eigen(matrix);
    const double values[] = {3, 1, -5};
    for (int64_t k = 0; k < 3; ++k) {
        CHECK(eigen.values[k] == Approx(values[k]));
        CHECK(eigen.vectors.col(k).norm() == Approx(1));
        CHECK((matrix * eigen.vectors.col(k) - values[k] * eigen.vectors.col(k)).norm() < 1e-12);
    }
    CHECK((symmetric_eigenvalues(matrix) - eigen.values).norm() < 1e-12);
}

TEST_CASE("a matrix that is not finite has no eigenvalues, and is refused") {
    MatrixD matrix = MatrixD::Identity(4, 4);
    matrix(2, 1) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(symmetric_eigen(matrix), std::invalid_argument);
    CHECK_THROWS_AS(symmetric_eigenvalues(matrix), std::invalid_argument);
}

TEST_CASE("of equally large entries the first one decides the sign") {
    VectorD vector(3);
    vector << 0.5, -2, 2;
    make_largest_entry_positive(vector);
    CHECK(vector[1] == 2);
    CHECK(vector[2] == -2);
    make_largest_entry_positive(vector);
    CHECK(vector[1] == 2);
}
