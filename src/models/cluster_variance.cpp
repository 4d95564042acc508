#include "kinetome/models/cluster_variance.h"

#include <map>
#include <stdexcept>

#include "kinetome/math/point_cloud.h"
#include "kinetome/math/warp.h"

namespace kinetome {
namespace {

const WarpOptions classical{.steps = unlimited_steps(), .weight = WarpWeight::cells};

void check(const MatrixFView& features, const MatrixFView& point_clouds,
           std::span<const RowRange> primitives, std::span<const int32_t> clusters) {
    if (features.rows() != point_clouds.rows()) {
        throw std::invalid_argument("features and point clouds are of different frames");
    }
    if (clusters.size() != primitives.size()) {
        throw std::invalid_argument("not every primitive has a cluster");
    }
    for (const RowRange& primitive : primitives) {
        if (primitive.first < 0 || primitive.size() < 1 || primitive.end > features.rows()) {
            throw std::invalid_argument("a primitive is empty or leaves its take");
        }
    }
}

ClusterVariance variance_of(const MatrixFView& features, const MatrixFView& point_clouds,
                            const std::vector<RowRange>& members) {
    std::vector<double> in_clouds, in_features, lengths;
    const auto rows = [](const MatrixFView& matrix, const RowRange& range) {
        return matrix.middleRows(range.first, range.size());
    };
    for (size_t i = 0; i < members.size(); ++i) {
        const RowRange& a = members[i];
        lengths.push_back(double(a.size()));
        for (size_t j = i + 1; j < members.size(); ++j) {
            const RowRange& b = members[j];
            const double of_features = warp(rows(features, a), rows(features, b), classical).total;
            const double of_clouds =
                warp(point_cloud_distances(rows(point_clouds, a), rows(point_clouds, b)), classical)
                    .total;
            // The path back is the same.
            for (const RowRange& reference : {a, b}) {
                in_features.push_back(of_features / double(reference.size()));
                in_clouds.push_back(of_clouds / double(reference.size()));
            }
        }
    }
    return {0, static_cast<int64_t>(members.size()), mean_and_variance(in_clouds),
            mean_and_variance(in_features), mean_and_variance(lengths)};
}

}  // namespace

MeanAndVariance mean_and_variance(std::span<const double> values) {
    if (values.empty()) return {};
    MeanAndVariance result;
    for (const double value : values) result.mean += value;
    result.mean /= double(values.size());
    for (const double value : values) {
        result.variance += (value - result.mean) * (value - result.mean);
    }
    if (values.size() > 1) result.variance /= double(values.size() - 1);
    return result;
}

std::vector<ClusterVariance> cluster_variances(const MatrixFView& features,
                                               const MatrixFView& point_clouds,
                                               std::span<const RowRange> primitives,
                                               std::span<const int32_t> clusters) {
    check(features, point_clouds, primitives, clusters);
    std::map<int32_t, std::vector<RowRange>> members;
    for (size_t p = 0; p < primitives.size(); ++p) members[clusters[p]].push_back(primitives[p]);
    std::vector<ClusterVariance> variances;
    for (const auto& [cluster, ranges] : members) {
        variances.push_back(variance_of(features, point_clouds, ranges));
        variances.back().cluster = cluster;
    }
    return variances;
}

}  // namespace kinetome
