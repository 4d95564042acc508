// nanoflann's kd-tree behind the calls of the other engines.
#pragma once

#include <cstdint>
#include <nanoflann.hpp>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/parallel.h"
#include "kinetome/math/knn.h"
#include "knn_lists.h"

namespace kinetome::bench {

class NanoflannSearch {
  public:
    NanoflannSearch(const MatrixF& rows, const KnnOptions& options, int leaf)
        : options_(options),
          points_{rows},
          tree_(int(rows.cols()), points_,
                nanoflann::KDTreeSingleIndexAdaptorParams(size_t(leaf))) {
        tree_.buildIndex();
    }
    Lists search(const MatrixF& queries, int threads) const {
        const auto most = static_cast<size_t>(options_.neighbours);
        Lists lists(size_t(queries.rows()));
        parallel_for(threads, queries.rows(), [&](int64_t q) {
            std::vector<uint32_t> rows(most);
            std::vector<float> squared(most);
            nanoflann::KNNResultSet<float, uint32_t> found(most);
            found.init(rows.data(), squared.data());
            squared.back() = static_cast<float>(
                options_.radius * options_.radius);  // it takes what is nearer than its last
            tree_.findNeighbors(found, queries.row(q).data(), nanoflann::SearchParams());
            for (size_t i = 0; i < found.size(); ++i)
                lists[size_t(q)].emplace_back(squared[i], rows[i]);
        });
        return lists;
    }

  private:
    struct Points {
        const MatrixF& rows;
        size_t kdtree_get_point_count() const { return size_t(rows.rows()); }
        float kdtree_get_pt(size_t row, size_t column) const {
            return rows(int64_t(row), int64_t(column));
        }
        template <class Box>
        bool kdtree_get_bbox(Box&) const {
            return false;
        }
    };
    const KnnOptions options_;
    Points points_;
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Adaptor<float, Points>, Points> tree_;
};

}  // namespace kinetome::bench
