// k-means of few rows in memory, the best of several k-means++ starts.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "kinetome/base/matrix.h"

namespace kinetome {

struct KMeansOptions {
    int64_t clusters = 2;  ///< at most; fewer where fewer rows are distinct
    int restarts = 20;     ///< starts; the one of least squared distance is kept, ties to the first
    int max_iterations = 100;  ///< of Lloyd's algorithm from each start
    uint64_t seed = 1;         ///< of the k-means++ starts (Arthur & Vassilvitskii 2007)
};

/// The cluster of each row (n × d), numbered from 0; ties to the lowest. A number may be unused.
/// Throws std::invalid_argument unless clusters and restarts are positive.
std::vector<int32_t> kmeans(const MatrixDView& rows, const KMeansOptions& options);

}  // namespace kinetome
