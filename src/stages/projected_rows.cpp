#include "kinetome/stages/projected_rows.h"

#include <algorithm>

#include "kinetome/base/piece_sum.h"

namespace kinetome {

ProjectedRows::ProjectedRows(const PosePartition& partition, const Pca& pca, const Workers& workers,
                             uint64_t kept_bytes, StopToken stop)
    : partition_(partition), pca_(pca), stop_(stop), kept_(partition.layout.pieces.size()) {
    const auto row_bytes = static_cast<uint64_t>(pca_.dimension()) * sizeof(float);
    const auto most_rows = static_cast<int64_t>(kept_bytes / std::max<uint64_t>(row_bytes, 1));
    for (const int64_t p :
         share_of_pieces(partition.layout, workers.rank(), workers.rank_count())) {
        const int64_t rows = partition.layout.pieces[static_cast<size_t>(p)].size();
        if (kept_rows_ + rows > most_rows) break;
        kept_[static_cast<size_t>(p)].keep = true;
        kept_rows_ += rows;
    }
}

MatrixF ProjectedRows::project(const RowRange& range) const {
    stop_.check();
    return pca_.project(partition_.read(range));
}

std::shared_ptr<const MatrixF> ProjectedRows::kept(int64_t piece) const {
    KeptPiece& place = kept_[static_cast<size_t>(piece)];
    std::call_once(place.once, [&] {
        place.rows = std::make_shared<const MatrixF>(
            project(partition_.layout.pieces[static_cast<size_t>(piece)]));
    });
    return place.rows;
}

RowBlock ProjectedRows::read(const RowRange& range) const {
    const auto& pieces = partition_.layout.pieces;
    const auto after =
        std::upper_bound(pieces.begin(), pieces.end(), range.first,
                         [](int64_t row, const RowRange& piece) { return row < piece.first; });
    const int64_t piece = after - pieces.begin() - 1;
    for (auto p = static_cast<size_t>(piece); p < pieces.size() && pieces[p].first < range.end;
         ++p) {
        if (!kept_[p].keep) return RowBlock(project(range));
    }

    const RowRange& whole = pieces[static_cast<size_t>(piece)];
    if (range.end <= whole.end) {
        return RowBlock(kept(piece), range.first - whole.first, range.size());
    }
    MatrixF rows(range.size(), columns());
    for (int64_t p = piece, row = range.first; row < range.end; ++p) {
        const RowRange& from = pieces[static_cast<size_t>(p)];
        const int64_t count = std::min(from.end, range.end) - row;
        rows.middleRows(row - range.first, count) = kept(p)->middleRows(row - from.first, count);
        row += count;
    }
    return RowBlock(std::move(rows));
}

}  // namespace kinetome
