// One query looked for in many sequences by subsequence dynamic time warping, most of which bounds
// spare.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"
#include "kinetome/math/warp.h"

namespace kinetome {

class WarpBounds;
class WarpQuery;

/// Sequences made ready to be searched, with a copy of them.
class WarpSearch {
  public:
    /// Each sequence is a range of the n × d rows. Throws std::invalid_argument for a range that is
    /// empty or not among the rows, for a value in one that is not finite, and unless each step
    /// goes on in the query (the first sequence of warp.h).
    WarpSearch(const MatrixFView& rows, std::span<const RowRange> sequences,
               std::vector<WarpStep> steps = slope_limited_steps());
    ~WarpSearch();
    WarpSearch(WarpSearch&&) noexcept;
    WarpSearch& operator=(WarpSearch&&) noexcept;

    int64_t sequences() const { return static_cast<int64_t>(sequences_.size()); }
    /// As they were given.
    MatrixFView rows_of(int64_t sequence) const {
        const RowRange& range = sequences_[static_cast<size_t>(sequence)];
        return rows_.middleRows(range.first, range.size());
    }

    /// The query must not outlive this. Throws std::invalid_argument for rows of another dimension
    /// or that are not finite, and for none.
    WarpQuery query(const MatrixFView& rows) const;

  private:
    friend class WarpQuery;

    MatrixF rows_;                     ///< of the sequences, one after another
    std::vector<RowRange> sequences_;  ///< of rows_
    std::vector<WarpStep> steps_;
    std::unique_ptr<const WarpBounds> bounds_;  ///< nothing without sequences
};

/// What a query costs in each of the sequences: the least mean of its warp_matches there, to the
/// bit.
class WarpQuery {
  public:
    /// No match costs less.
    double bound(int64_t sequence) const { return bounds_[static_cast<size_t>(sequence)]; }

    /// The cost of the cheapest match where it is no more than `at_most`, else infinite: a search
    /// that can no longer come to less is given up.
    double cost(int64_t sequence, double at_most) const;

  private:
    friend class WarpSearch;
    WarpQuery(const WarpSearch& search, const MatrixFView& rows);

    const WarpSearch& search_;
    MatrixF rows_;
    std::vector<double> bounds_;
};

}  // namespace kinetome
