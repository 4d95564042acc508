#include "kinetome/math/knn.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "kinetome/base/parallel.h"
#include "knn_search.h"
#include "mixture_input.h"

namespace kinetome {
namespace {

constexpr int64_t queries_at_once = 256;

void check_rows(const MatrixFView& rows) {
    if (rows.cols() == 0) throw std::invalid_argument("rows without columns have no neighbours");
    if (rows.rows() > std::numeric_limits<int32_t>::max()) {
        throw std::invalid_argument(std::to_string(rows.rows()) +
                                    " rows are more than a neighbour search can number");
    }
    require_finite(rows, 0);
}

void append(const NeighbourLists& part, NeighbourLists& lists) {
    const int64_t before = lists.offsets.back();
    for (size_t i = 1; i < part.offsets.size(); ++i) {
        lists.offsets.push_back(before + part.offsets[i]);
    }
    lists.rows.insert(lists.rows.end(), part.rows.begin(), part.rows.end());
    lists.distances.insert(lists.distances.end(), part.distances.begin(), part.distances.end());
}

}  // namespace

KnnIndex::KnnIndex(const MatrixFView& rows, KnnEngine engine, int threads)
    : rows_(rows.rows()), columns_(rows.cols()) {
    check_rows(rows);
    search_ =
        engine == KnnEngine::flann ? make_flann_search(rows) : make_block_search(rows, threads);
}

KnnIndex::~KnnIndex() = default;
KnnIndex::KnnIndex(KnnIndex&&) noexcept = default;
KnnIndex& KnnIndex::operator=(KnnIndex&&) noexcept = default;

NeighbourLists KnnIndex::search(const MatrixFView& queries, const KnnOptions& options, int threads,
                                std::span<const RowRange> excluded) const {
    if (queries.cols() != columns_) {
        throw std::invalid_argument("queries of " + std::to_string(queries.cols()) +
                                    " columns were put to rows of " + std::to_string(columns_));
    }
    if (!(options.radius >= 0)) throw std::invalid_argument("a radius is 0 or more");
    if (options.neighbours < 1) throw std::invalid_argument("neighbours: at least 1 is asked for");
    if (!excluded.empty() && static_cast<int64_t>(excluded.size()) != queries.rows()) {
        throw std::invalid_argument("excluded rows: one range for each query, or none at all");
    }
    require_finite(queries, 0);

    const int64_t count = (queries.rows() + queries_at_once - 1) / queries_at_once;
    std::vector<NeighbourLists> parts(static_cast<size_t>(count));
    // Lists cannot be longer than the rows, and room is made for what is asked for.
    const KnnOptions asked{options.radius,
                           std::clamp<int64_t>(options.neighbours, 1, std::max<int64_t>(rows_, 1))};
    parallel_for(threads, count, [&](int64_t part) {
        const int64_t first = part * queries_at_once;
        const int64_t size = std::min(queries_at_once, queries.rows() - first);
        parts[size_t(part)] = search_->search(
            queries.middleRows(first, size), asked,
            excluded.empty() ? excluded : excluded.subspan(size_t(first), size_t(size)));
    });
    NeighbourLists lists;
    for (NeighbourLists& part : parts) append(std::exchange(part, {}), lists);
    return lists;
}

std::vector<RowRange> rows_nearby_in_time(std::span<const int64_t> clip_offsets,
                                          const RowRange& queries, int64_t frames) {
    std::vector<RowRange> nearby;
    for (int64_t row = queries.first; row < queries.end; ++row) {
        const auto end = std::upper_bound(clip_offsets.begin(), clip_offsets.end(), row);
        if (end == clip_offsets.begin() || end == clip_offsets.end()) {
            throw std::invalid_argument("row " + std::to_string(row) + " belongs to no clip");
        }
        nearby.push_back({std::max(*(end - 1), row - frames + 1), std::min(*end, row + frames)});
    }
    return nearby;
}

}  // namespace kinetome
