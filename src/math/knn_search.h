// What an engine of the neighbour search is.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kinetome/math/knn.h"
#include "knn_nearest.h"

namespace kinetome {

/// Neighbours of query i: [offsets[i], offsets[i + 1]), the nearest first.
struct MeasuredLists {
    std::vector<int64_t> offsets{0};
    std::vector<Neighbour> neighbours;
};

class KnnSearch {
  public:
    virtual ~KnnSearch() = default;
    /// At most `most` neighbours of each query, no farther than the root of its own of
    /// `squared_limits`. On one thread; many may call at once. KnnIndex has checked what it passes
    /// on.
    virtual MeasuredLists search(const MatrixFView& queries, int64_t most,
                                 std::span<const double> squared_limits,
                                 std::span<const RowRange> excluded) const = 0;
};

std::unique_ptr<const KnnSearch> make_block_search(const MatrixFView& rows, int threads);
std::unique_ptr<const KnnSearch> make_flann_search(const MatrixFView& rows);

}  // namespace kinetome
