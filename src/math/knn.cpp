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

void append(const MeasuredLists& part, NeighbourLists& lists) {
    const int64_t before = lists.offsets.back();
    for (size_t i = 1; i < part.offsets.size(); ++i) {
        lists.offsets.push_back(before + part.offsets[i]);
    }
    for (const Neighbour& neighbour : part.neighbours) {
        lists.rows.push_back(neighbour.row);
        lists.distances.push_back(static_cast<float>(std::sqrt(neighbour.squared)));
    }
}

/// Nothing beyond it can enter the list.
double squared_limit(const std::vector<RowOfWhole>& list, double radius, int64_t most) {
    const bool full = static_cast<int64_t>(list.size()) >= most;
    return full ? list.back().squared : radius * radius;
}

void enter(std::span<const Neighbour> found, int64_t first_row, int64_t most,
           std::vector<RowOfWhole>& list) {
    const auto before = static_cast<std::ptrdiff_t>(list.size());
    for (const Neighbour& one : found) list.push_back({one.squared, first_row + one.row});
    std::inplace_merge(list.begin(), list.begin() + before, list.end());
    if (static_cast<int64_t>(list.size()) > most) list.resize(size_t(most));
}

/// The part of what there is one of for each query, or for none.
template <class T>
std::span<const T> part_of(std::span<const T> all, int64_t first, int64_t size) {
    return all.empty() ? all : all.subspan(size_t(first), size_t(size));
}

/// Calls search(part, first, size) for runs of queries, on so many threads.
template <class Search>
void for_query_runs(int64_t queries, int threads, const Search& search) {
    parallel_for(threads, (queries + queries_at_once - 1) / queries_at_once, [&](int64_t run) {
        const int64_t first = run * queries_at_once;
        search(run, first, std::min(queries_at_once, queries - first));
    });
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

void KnnIndex::check_queries(const MatrixFView& queries, int64_t most,
                             std::span<const RowRange> excluded) const {
    if (queries.cols() != columns_) {
        throw std::invalid_argument("queries of " + std::to_string(queries.cols()) +
                                    " columns were put to rows of " + std::to_string(columns_));
    }
    if (most < 1) throw std::invalid_argument("neighbours: at least 1 is asked for");
    if (!excluded.empty() && static_cast<int64_t>(excluded.size()) != queries.rows()) {
        throw std::invalid_argument("excluded rows: one range for each query, or none at all");
    }
    require_finite(queries, 0);
}

NeighbourLists KnnIndex::search(const MatrixFView& queries, const KnnOptions& options, int threads,
                                std::span<const RowRange> excluded) const {
    check_queries(queries, options.neighbours, excluded);
    if (!(options.radius >= 0)) throw std::invalid_argument("a radius is 0 or more");
    // Lists cannot be longer than the rows, and room is made for what is asked for.
    const int64_t most = std::min(options.neighbours, std::max<int64_t>(rows_, 1));
    const std::vector<double> limits(size_t(queries.rows()), options.radius * options.radius);
    std::vector<MeasuredLists> runs(
        static_cast<size_t>((queries.rows() + queries_at_once - 1) / queries_at_once));
    for_query_runs(queries.rows(), threads, [&](int64_t run, int64_t first, int64_t size) {
        runs[size_t(run)] =
            search_->search(queries.middleRows(first, size), most,
                            part_of<double>(limits, first, size), part_of(excluded, first, size));
    });
    NeighbourLists lists;
    for (MeasuredLists& run : runs) append(std::exchange(run, {}), lists);
    return lists;
}

void KnnIndex::search_more(const MatrixFView& queries, int64_t first_row, ListsOfWhole& lists,
                           int threads, std::span<const RowRange> excluded) const {
    check_queries(queries, lists.most, excluded);
    const auto count = static_cast<size_t>(queries.rows());
    if (lists.radii.size() != count || lists.lists.size() != count) {
        throw std::invalid_argument("lists of a whole: one radius and one list for each query");
    }
    const int64_t most = std::min(lists.most, std::max<int64_t>(rows_, 1));
    for_query_runs(queries.rows(), threads, [&](int64_t, int64_t first, int64_t size) {
        std::vector<double> limits;
        for (int64_t q = first; q < first + size; ++q) {
            limits.push_back(
                squared_limit(lists.lists[size_t(q)], lists.radii[size_t(q)], lists.most));
        }
        const MeasuredLists found = search_->search(queries.middleRows(first, size), most, limits,
                                                    part_of(excluded, first, size));
        for (int64_t q = 0; q < size; ++q) {
            const auto begin = static_cast<size_t>(found.offsets[size_t(q)]);
            const auto end = static_cast<size_t>(found.offsets[size_t(q) + 1]);
            enter(std::span(found.neighbours).subspan(begin, end - begin), first_row, lists.most,
                  lists.lists[size_t(first + q)]);
        }
    });
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
