#include <algorithm>
#include <cmath>

#include "knn_blocks.h"
#include "knn_search.h"
#include "knn_tile.h"

namespace kinetome {
namespace {

class BlockSearch final : public KnnSearch {
  public:
    BlockSearch(const MatrixFView& rows, int threads) : blocks_(rows, threads) {}

    NeighbourLists search(const MatrixFView& queries, const KnnOptions& options,
                          std::span<const RowRange> excluded) const override {
        NeighbourLists lists;
        QueryTile tile(blocks_, options);
        for (int64_t first = 0; first < queries.rows(); first += octet) {
            const int64_t count = std::min(octet, queries.rows() - first);
            tile.search(
                queries.middleRows(first, count),
                excluded.empty() ? excluded : excluded.subspan(size_t(first), size_t(count)));
            for (int64_t q = 0; q < count; ++q) append(tile.neighbours(q), lists);
        }
        return lists;
    }

  private:
    static void append(std::span<const Neighbour> neighbours, NeighbourLists& lists) {
        for (const Neighbour& neighbour : neighbours) {
            lists.rows.push_back(neighbour.row);
            lists.distances.push_back(static_cast<float>(std::sqrt(neighbour.squared)));
        }
        lists.offsets.push_back(static_cast<int64_t>(lists.rows.size()));
    }

    RowBlocks blocks_;
};

}  // namespace

std::unique_ptr<const KnnSearch> make_block_search(const MatrixFView& rows, int threads) {
    return std::make_unique<BlockSearch>(rows, threads);
}

}  // namespace kinetome
