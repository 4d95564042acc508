// Which substrings match those that begin at one letter (S1 §3.4): all ends at once, bit-parallel.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/models/letter_index.h"
#include "kinetome/models/reach_mask.h"
#include "kinetome/models/substring.h"

namespace kinetome {

/// What reach tables are made of; they refer to all of it.
struct MatchingContext {
    const MotionString& string;
    const AccessibilityMatrix& accessibility;
    const LetterIndex& index;
    const IntervalSet& open;   ///< intervals not partitioned yet; breaks between clips never are
    int32_t most_letters = 2;  ///< longest substring that may match, ReachMask::bits at most
};

/// Bit d of `starts`: a valid path (S1 §3.4) leads through SSA from (first row, column - d) to
/// (this row, column); so those two substrings match.
template <int Words>
struct ReachCell {
    int32_t column = 0;
    ReachMask<Words> starts;
};

/// The table of substrings that begin at letter `first`: row r holds the cells reached in letter
/// first + r, columns ascending, those with no bit left out.
///
/// A path from column - d to column passes every interval between the two, so what a table says of
/// a match stays true as long as the match's intervals stay open: rows made earlier need no
/// renewal, only starts that the caller finds beyond a closed interval are to be left out.
template <int Words>
class ReachTable {
  public:
    explicit ReachTable(int32_t first) : first_(first) {}

    int32_t rows() const { return static_cast<int32_t>(row_begin_.size()) - 1; }
    /// Makes rows up to that of letter `last`, or to the first that is empty. Intervals from the
    /// first letter to `last` are open.
    void extend_to(int32_t last, const MatchingContext& context);
    /// Whether that would make nothing.
    bool holds(int32_t last) const { return rows() > 0 && (last - first_ < rows() || ended()); }
    /// Empty where no row was made.
    std::span<const ReachCell<Words>> row_of(int32_t last) const;
    uint64_t bytes() const;

  private:
    void make_first_row(const MatchingContext& context);
    void append_row(const MatchingContext& context);
    bool ended() const { return row_begin_[row_begin_.size() - 2] == cells_.size(); }

    int32_t first_;
    std::vector<ReachCell<Words>> cells_;  ///< row after row
    std::vector<size_t> row_begin_{0};     ///< rows + 1, into cells_
};

}  // namespace kinetome
