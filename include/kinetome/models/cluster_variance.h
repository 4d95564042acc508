// How much the primitives of a cluster differ among themselves (S3 §5.2, Fig. 5 a–c).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"

namespace kinetome {

struct MeanAndVariance {
    double mean = 0;
    double variance = 0;  ///< with one degree of freedom less than values; 0 for a single one
};

/// Of the values in order; zeros for none.
MeanAndVariance mean_and_variance(std::span<const double> values);

/// Distances are those of S3's sum over pairs, one value for each ordered pair of primitives: the
/// cost of warping one onto the other, summed along the path, by frames of the first.
struct ClusterVariance {
    int32_t cluster = 0;
    int64_t primitives = 0;
    MeanAndVariance point_clouds;  ///< cm a frame
    MeanAndVariance features;      ///< the same in feature space
    MeanAndVariance frames;        ///< lengths of the primitives
};

/// Of each cluster in ascending order. `features` (n × d) and `point_clouds` (n × 3p; cm, Y up: see
/// point_cloud.h) are those of all takes one below the other; S3 stacks each frame with those
/// before and after it in both. Throws std::invalid_argument for primitives that are empty or leave
/// the rows, and when there are not as many clusters as primitives.
std::vector<ClusterVariance> cluster_variances(const MatrixFView& features,
                                               const MatrixFView& point_clouds,
                                               std::span<const RowRange> primitives,
                                               std::span<const int32_t> clusters);

}  // namespace kinetome
