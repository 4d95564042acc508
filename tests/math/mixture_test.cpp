#include "kinetome/math/mixture.h"

#include <catch2/catch.hpp>

#include "kinetome/base/random.h"

using namespace kinetome;

TEST_CASE("well separated clusters are found again") {
    RandomStream random(1, "test");
    MatrixF rows(600, 3);
    for (int64_t i = 0; i < rows.rows(); ++i) {
        for (int64_t j = 0; j < 3; ++j) {
            rows(i, j) = float(double(i % 3) * 10 + random.normal());
        }
    }
    const PieceLayout layout = layout_rows(rows.rows());
    const MixtureFit fit = fit_mixture(rows, layout, 3, {}, 2);
    CHECK(fit.converged);
    CHECK(fit.model.variances.maxCoeff() < 1.2);
    CHECK(likeliest_clusters(fit.model, rows, 1) == likeliest_clusters(fit.model, rows, 2));
}
