// What an engine of the neighbour search is.
#pragma once

#include <memory>
#include <span>

#include "kinetome/math/knn.h"

namespace kinetome {

class KnnSearch {
  public:
    virtual ~KnnSearch() = default;
    /// On one thread; many may call at once. KnnIndex has checked what it passes on.
    virtual NeighbourLists search(const MatrixFView& queries, const KnnOptions& options,
                                  std::span<const RowRange> excluded) const = 0;
};

std::unique_ptr<const KnnSearch> make_block_search(const MatrixFView& rows, int threads);
std::unique_ptr<const KnnSearch> make_flann_search(const MatrixFView& rows);

}  // namespace kinetome
