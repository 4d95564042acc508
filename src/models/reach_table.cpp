#include "kinetome/models/reach_table.h"

namespace kinetome {

template <int Words>
void ReachTable<Words>::extend_to(int32_t last, const MatchingContext& context) {
    if (rows() == 0) make_first_row(context);
    while (!holds(last)) append_row(context);
}

template <int Words>
std::span<const ReachCell<Words>> ReachTable<Words>::row_of(int32_t last) const {
    const int32_t row = last - first_;
    if (row >= rows()) return {};
    const size_t begin = row_begin_[static_cast<size_t>(row)];
    return {cells_.data() + begin, row_begin_[static_cast<size_t>(row) + 1] - begin};
}

template <int Words>
uint64_t ReachTable<Words>::bytes() const {
    return cells_.capacity() * sizeof(ReachCell<Words>) + row_begin_.capacity() * sizeof(size_t) +
           sizeof(*this);
}

/// A path begins at every accessible letter that a substring can go on from, and may stay in the
/// first row.
template <int Words>
void ReachTable<Words>::make_first_row(const MatchingContext& context) {
    const auto within = ReachMask<Words>::lowest(context.most_letters);
    const int32_t letter = context.string.letters[static_cast<size_t>(first_)];
    for (const int32_t column : context.index.accessible_positions(letter)) {
        ReachMask<Words> starts;
        if (!cells_.empty() && cells_.back().column == column - 1 &&
            context.open.contains(column - 1)) {
            starts = cells_.back().starts.shifted() & within;
        }
        if (context.open.run_after(column, 1) > 0) starts |= ReachMask<Words>::lowest(1);
        if (starts.any()) cells_.push_back({column, starts});
    }
    row_begin_.push_back(cells_.size());
}

/// T(a + 1, y) = A[s(a + 1), s(y)] · (T(a, y) | (T(a, y - 1) | T(a + 1, y - 1)) << 1), the latter
/// two while the interval before y is open.
template <int Words>
void ReachTable<Words>::append_row(const MatchingContext& context) {
    const auto within = ReachMask<Words>::lowest(context.most_letters);
    const int32_t letter = context.string.letters[static_cast<size_t>(first_ + rows())];
    size_t i = row_begin_[row_begin_.size() - 2];
    const size_t end = row_begin_.back();
    while (i < end) {
        int32_t column = cells_[i].column;
        ReachMask<Words> from_left;
        for (bool goes_on = true; goes_on; ++column) {
            ReachMask<Words> above;
            if (i < end && cells_[i].column == column) above = cells_[i++].starts;
            ReachMask<Words> here;
            if (context.accessibility(letter,
                                      context.string.letters[static_cast<size_t>(column)])) {
                here = (above | from_left.shifted()) & within;
            }
            if (here.any()) cells_.push_back({column, here});
            from_left = above | here;
            goes_on = from_left.any() && context.open.run_after(column, 1) > 0;
        }
    }
    row_begin_.push_back(cells_.size());
}

template class ReachTable<1>;
template class ReachTable<2>;
template class ReachTable<4>;
template class ReachTable<8>;

}  // namespace kinetome
