#include "kinetome/base/piece_sum.h"

#include <algorithm>

namespace kinetome {

RowRange share_of_pieces(const PieceLayout& layout, int rank, int rank_count) {
    // The first piece whose middle is at or beyond a rank's part of the rows begins its share.
    const auto begin_of = [&](int64_t part) {
        const auto& pieces = layout.pieces;
        const auto at = std::partition_point(pieces.begin(), pieces.end(), [&](const RowRange& p) {
            return (p.first + p.end) * rank_count < 2 * layout.rows() * part;
        });
        return static_cast<int64_t>(at - pieces.begin());
    };
    return {begin_of(rank), begin_of(rank + 1)};
}

}  // namespace kinetome
