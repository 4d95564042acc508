#include "kinetome/math/kept_rows.h"

#include <algorithm>
#include <utility>

#include "kinetome/base/piece_sum.h"

namespace kinetome {

KeptRows::KeptRows(const PieceLayout& layout, int64_t columns, Make make, const Workers& workers,
                   uint64_t kept_bytes)
    : layout_(layout), columns_(columns), make_(std::move(make)), kept_(layout.pieces.size()) {
    const auto row_bytes = static_cast<uint64_t>(columns) * sizeof(float);
    const auto most_rows = static_cast<int64_t>(kept_bytes / std::max<uint64_t>(row_bytes, 1));
    for (const int64_t p : share_of_pieces(layout, workers.rank(), workers.rank_count())) {
        const int64_t rows = layout.pieces[static_cast<size_t>(p)].size();
        if (kept_rows_ + rows > most_rows) break;
        kept_[static_cast<size_t>(p)].keep = true;
        kept_rows_ += rows;
    }
}

std::shared_ptr<const MatrixF> KeptRows::kept(int64_t piece) const {
    KeptPiece& place = kept_[static_cast<size_t>(piece)];
    std::call_once(place.once, [&] {
        place.rows =
            std::make_shared<const MatrixF>(make_(layout_.pieces[static_cast<size_t>(piece)]));
    });
    return place.rows;
}

RowBlock KeptRows::read(const RowRange& range) const {
    const auto& pieces = layout_.pieces;
    const auto after =
        std::upper_bound(pieces.begin(), pieces.end(), range.first,
                         [](int64_t row, const RowRange& piece) { return row < piece.first; });
    const int64_t piece = after - pieces.begin() - 1;
    for (auto p = static_cast<size_t>(piece); p < pieces.size() && pieces[p].first < range.end;
         ++p) {
        if (!kept_[p].keep) return RowBlock(make_(range));
    }

    const RowRange& whole = pieces[static_cast<size_t>(piece)];
    if (range.end <= whole.end) {
        return RowBlock(kept(piece), range.first - whole.first, range.size());
    }
    MatrixF rows(range.size(), columns_);
    for (int64_t p = piece, row = range.first; row < range.end; ++p) {
        const RowRange& from = pieces[static_cast<size_t>(p)];
        const int64_t count = std::min(from.end, range.end) - row;
        rows.middleRows(row - range.first, count) = kept(p)->middleRows(row - from.first, count);
        row += count;
    }
    return RowBlock(std::move(rows));
}

}  // namespace kinetome
