// The nearest rows within a radius, exactly (S3 §3: the neighbourhood graph of poses).
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"

namespace kinetome {

enum class KnnEngine {
    blocks,  ///< boxes around runs of consecutive rows; exact to the bit
    flann,   ///< FLANN's KDTreeSingleIndex, in float: the same but for rounding
};

struct KnnOptions {
    double radius = 72;        ///< in the units of the rows; rows at this distance count
    int64_t neighbours = 128;  ///< at most so many of each query, the nearest
};

/// Query i has neighbours [offsets[i], offsets[i + 1]), the nearest first.
struct NeighbourLists {
    std::vector<int64_t> offsets{0};
    std::vector<int32_t> rows;     ///< of the rows searched
    std::vector<float> distances;  ///< not squared

    int64_t queries() const { return static_cast<int64_t>(offsets.size()) - 1; }
    std::span<const int32_t> rows_of(int64_t query) const {
        return std::span(rows).subspan(first(query), first(query + 1) - first(query));
    }
    std::span<const float> distances_of(int64_t query) const {
        return std::span(distances).subspan(first(query), first(query + 1) - first(query));
    }

  private:
    size_t first(int64_t query) const { return static_cast<size_t>(offsets[size_t(query)]); }
};

/// A row of a whole that is searched part by part.
struct RowOfWhole {
    double squared = 0;  ///< distance
    int64_t row = 0;
    auto operator<=>(const RowOfWhole&) const = default;
};

/// The nearest rows of queries so far, while parts of a whole that is too large for one index are
/// searched one after another.
struct ListsOfWhole {
    int64_t most = 128;                          ///< neighbours of a query, the nearest
    std::vector<double> radii;                   ///< of each query
    std::vector<std::vector<RowOfWhole>> lists;  ///< of each query, the nearest first
};

class KnnSearch;

/// Rows made ready to be searched; keeps a copy of them, with boxes half as large again.
///
/// A squared distance is the sum of squared differences in double, column after column. Neighbours
/// are ordered by it, equal ones by row; a query that is one of the rows finds itself. With
/// KnnEngine::blocks the lists are those of comparing every pair, whatever the values, and do not
/// depend on threads or on which queries are asked together. Rows that follow each other in motion
/// are found fastest; no order is wrong.
class KnnIndex {
  public:
    /// Throws std::invalid_argument for a value that is not finite (naming its row), for rows
    /// without columns and for more than 2^31 - 1 rows.
    KnnIndex(const MatrixFView& rows, KnnEngine engine, int threads);
    ~KnnIndex();
    KnnIndex(KnnIndex&&) noexcept;
    KnnIndex& operator=(KnnIndex&&) noexcept;

    int64_t rows() const { return rows_; }
    int64_t columns() const { return columns_; }

    /// The lists of n × d queries. `excluded` is empty or holds, for each query, rows that are not
    /// to be found. Throws std::invalid_argument for queries of another dimension or that are not
    /// finite, and for a negative radius or less than one neighbour.
    NeighbourLists search(const MatrixFView& queries, const KnnOptions& options, int threads,
                          std::span<const RowRange> excluded = {}) const;

    /// Enters into the lists of the queries the rows of this index, as rows [first_row, first_row +
    /// rows()) of the whole. After all parts, in any order, the lists are those of one index of the
    /// whole, to the bit with KnnEngine::blocks. `excluded` holds rows of this index; throws as
    /// above, and unless there are a radius and a list for each query.
    void search_more(const MatrixFView& queries, int64_t first_row, ListsOfWhole& lists,
                     int threads, std::span<const RowRange> excluded = {}) const;

  private:
    void check_queries(const MatrixFView& queries, int64_t most,
                       std::span<const RowRange> excluded) const;

    int64_t rows_;
    int64_t columns_;
    std::unique_ptr<const KnnSearch> search_;
};

/// For each row of `queries`, the rows of the same clip that are less than `frames` away: itself
/// and frames - 1 to either side. Clip c holds rows [clip_offsets[c], clip_offsets[c + 1]).
std::vector<RowRange> rows_nearby_in_time(std::span<const int64_t> clip_offsets,
                                          const RowRange& queries, int64_t frames);

}  // namespace kinetome
