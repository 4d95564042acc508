#include "kinetome/models/cluster_variance.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

using namespace kinetome;

namespace {

/// Four frames a movement; one point at a height of its own each, whose features are that height.
MatrixF heights(const std::vector<float>& values) {
    MatrixF rows(values.size(), 1);
    for (size_t i = 0; i < values.size(); ++i) rows(static_cast<int64_t>(i), 0) = values[i];
    return rows;
}

MatrixF clouds_of(const MatrixF& rows) {
    MatrixF clouds = MatrixF::Zero(rows.rows(), 3);
    clouds.col(1) = rows;
    return clouds;
}

}  // namespace

TEST_CASE("pairs of a cluster are compared, warped, by frames of each") {
    // Cluster 3: the second holds its first height longer (no cost), the third is 1 higher.
    const MatrixF rows = heights({0, 5, 0, 0, 5, 1, 6, 9, 9, 9});
    const std::vector<RowRange> primitives = {{0, 2}, {2, 5}, {5, 7}, {7, 10}};
    const auto variances =
        cluster_variances(rows, clouds_of(rows), primitives, std::vector<int32_t>{3, 3, 3, 8});
    REQUIRE(variances.size() == 2);
    CHECK(variances[0].cluster == 3);
    CHECK(variances[0].primitives == 3);
    // Costs 0, 2 and 3 of the three pairs, by 2 or 3 frames, both ways round.
    const std::vector<double> values = {0, 0, 2 / 2.0, 2 / 2.0, 3 / 3.0, 3 / 2.0};
    const MeanAndVariance expected = mean_and_variance(values);
    CHECK(variances[0].features.mean == Approx(expected.mean));
    CHECK(variances[0].features.variance == Approx(expected.variance));
    CHECK(variances[0].point_clouds.mean == Approx(expected.mean));
    CHECK(variances[0].point_clouds.variance == Approx(expected.variance));
    CHECK(variances[0].frames.mean == Approx(7 / 3.0));
    CHECK(variances[0].frames.variance == Approx(1 / 3.0));
    CHECK(variances[1].primitives == 1);
    CHECK(variances[1].features.mean == 0);
    CHECK(variances[1].frames.mean == 3);
    CHECK(variances[1].frames.variance == 0);
}

TEST_CASE("the variance is that of a sample") {
    CHECK(mean_and_variance(std::vector<double>{1, 2, 3, 6}).mean == 3);
    CHECK(mean_and_variance(std::vector<double>{1, 2, 3, 6}).variance == Approx(14 / 3.0));
    CHECK(mean_and_variance({}).variance == 0);
}

TEST_CASE("primitives that are not of the rows are refused") {
    const MatrixF rows = heights({0, 1, 2});
    const auto refused = [&](const std::vector<RowRange>& primitives,
                             const std::vector<int32_t>& clusters) {
        CHECK_THROWS_AS(cluster_variances(rows, clouds_of(rows), primitives, clusters),
                        std::invalid_argument);
    };
    refused({{0, 4}}, {0});
    refused({{-1, 2}}, {0});
    refused({{1, 1}}, {0});
    refused({{0, 2}}, {});
    CHECK_THROWS_AS(cluster_variances(rows, clouds_of(rows).topRows(2), {}, {}),
                    std::invalid_argument);
}
