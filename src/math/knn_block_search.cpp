#include <algorithm>

#include "knn_blocks.h"
#include "knn_search.h"
#include "knn_tile.h"

namespace kinetome {
namespace {

class BlockSearch final : public KnnSearch {
  public:
    BlockSearch(const MatrixFView& rows, int threads) : blocks_(rows, threads) {}

    MeasuredLists search(const MatrixFView& queries, int64_t most,
                         std::span<const double> squared_limits,
                         std::span<const RowRange> excluded) const override {
        MeasuredLists lists;
        QueryTile tile(blocks_, most);
        for (int64_t first = 0; first < queries.rows(); first += octet) {
            const int64_t count = std::min(octet, queries.rows() - first);
            tile.search(
                queries.middleRows(first, count),
                squared_limits.subspan(size_t(first), size_t(count)),
                excluded.empty() ? excluded : excluded.subspan(size_t(first), size_t(count)));
            for (int64_t q = 0; q < count; ++q) {
                const auto found = tile.neighbours(q);
                lists.neighbours.insert(lists.neighbours.end(), found.begin(), found.end());
                lists.offsets.push_back(static_cast<int64_t>(lists.neighbours.size()));
            }
        }
        return lists;
    }

  private:
    RowBlocks blocks_;
};

}  // namespace

std::unique_ptr<const KnnSearch> make_block_search(const MatrixFView& rows, int threads) {
    return std::make_unique<BlockSearch>(rows, threads);
}

}  // namespace kinetome
