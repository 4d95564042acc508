// FLANN's exact kd-tree behind the same call.
#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "knn_search.h"

namespace kinetome {
namespace {

using Tree = flann::KDTreeSingleIndex<flann::L2<float>>;

/// FLANN asks for pointers to values it may write; it writes none.
flann::Matrix<float> as_flann(const MatrixF& rows) {
    return {const_cast<float*>(rows.data()), static_cast<size_t>(rows.rows()),
            static_cast<size_t>(rows.cols())};
}

class FlannSearch final : public KnnSearch {
  public:
    explicit FlannSearch(const MatrixFView& rows)
        : rows_(rows), tree_(as_flann(rows_), flann::KDTreeSingleIndexParams()) {
        if (rows.rows() > 0) tree_.buildIndex();
    }

    MeasuredLists search(const MatrixFView& queries, int64_t most,
                         std::span<const double> squared_limits,
                         std::span<const RowRange> excluded) const override {
        // It cannot leave rows out: more are asked for, then the excluded ones are dropped.
        int64_t widest = 0;
        for (const RowRange& range : excluded) widest = std::max(widest, range.size());
        const int64_t asked = std::min(most + widest, rows_.rows());
        flann::SearchParams parameters(flann::FLANN_CHECKS_UNLIMITED, 0, true);
        parameters.max_neighbors = static_cast<int>(asked);
        std::vector<std::vector<size_t>> rows;
        std::vector<std::vector<float>> squared;
        if (asked > 0 && queries.rows() > 0) {
            // It takes only what is nearer than the radius.
            const auto limit = static_cast<float>(std::ranges::max(squared_limits));
            tree_.radiusSearch(as_flann(queries), rows, squared,
                               std::nextafter(limit, std::numeric_limits<float>::infinity()),
                               parameters);
        }
        rows.resize(size_t(queries.rows()));
        squared.resize(size_t(queries.rows()));

        MeasuredLists lists;
        for (size_t q = 0; q < rows.size(); ++q) {
            const RowRange left_out = excluded.empty() ? RowRange{} : excluded[q];
            const auto limit = static_cast<float>(squared_limits[q]);
            const auto full = lists.offsets.back() + most;
            for (size_t i = 0; i < rows[q].size(); ++i) {
                const auto row = static_cast<int64_t>(rows[q][i]);
                if (row >= left_out.first && row < left_out.end) continue;
                if (static_cast<int64_t>(lists.neighbours.size()) == full) break;
                if (squared[q][i] > limit) break;
                lists.neighbours.push_back({double(squared[q][i]), static_cast<int32_t>(row)});
            }
            lists.offsets.push_back(static_cast<int64_t>(lists.neighbours.size()));
        }
        return lists;
    }

  private:
    const MatrixF rows_;
    Tree tree_;
};

}  // namespace

std::unique_ptr<const KnnSearch> make_flann_search(const MatrixFView& rows) {
    return std::make_unique<FlannSearch>(rows);
}

}  // namespace kinetome
