#include <algorithm>
#include <limits>

#include "candidate_search.h"
#include "frame_super.h"
#include "kinetome/base/piece_sum.h"
#include "kinetome/math/mixture.h"
#include "mixture_input.h"

namespace kinetome {
namespace {

/// The likeliest of the candidates, in double from the row itself: the answer does not depend on
/// which rows it was searched together with.
int32_t likeliest_of(std::span<const int32_t> candidates, const ClusterDensities& densities,
                     const float* row) {
    double best = -std::numeric_limits<double>::infinity();
    int32_t likeliest = candidates.front();
    for (const int32_t cluster : candidates) {
        double squared = 0;
        for (int64_t j = 0; j < densities.dimension(); ++j) {
            const double difference = double(row[j]) - densities.means(cluster, j);
            squared += difference * difference;
        }
        const auto k = static_cast<size_t>(cluster);
        const double density = densities.offsets[k] + densities.slopes[k] * squared;
        if (density > best) {
            best = density;
            likeliest = cluster;
        }
    }
    return likeliest;
}

/// Letters of a run of rows, whose first has the number `first_row`.
void assign(const ClusterDensities& densities, const ClusterGroups& groups, const MatrixFView& rows,
            int64_t first_row, int32_t* likeliest) {
    FrameSuper frames(densities.dimension());
    CandidateSearch search(groups, 0.0F);
    for (int64_t first = 0; first < rows.rows(); first += super_rows) {
        frames.load(rows, {first, std::min(first + super_rows, rows.rows())}, first_row);
        search.run(frames);
        for (int64_t i = 0; i < frames.size(); ++i) {
            likeliest[first + i] = likeliest_of(search.candidates(i / tile_rows), densities,
                                                rows.data() + (first + i) * rows.outerStride());
        }
    }
}

/// Each rank brings the letters of its share; all have all of them afterwards.
void exchange(const PieceLayout& layout, const Workers& workers, std::vector<int32_t>& letters) {
    const auto share_of = [&](int rank) {
        return share_of_pieces(layout, rank, workers.rank_count());
    };
    std::vector<int32_t> mine;
    for (const int64_t p : share_of(workers.rank())) {
        const RowRange& piece = layout.pieces[static_cast<size_t>(p)];
        mine.insert(mine.end(), letters.begin() + piece.first, letters.begin() + piece.end);
    }
    std::vector<std::string> parts = workers.ranks->gather_to_all(packed(mine));
    for (int rank = 0; rank < workers.rank_count(); ++rank) {
        const auto theirs =
            unpacked<std::vector<int32_t>>(std::move(parts[static_cast<size_t>(rank)]));
        auto next = theirs.begin();
        for (const int64_t p : share_of(rank)) {
            const RowRange& piece = layout.pieces[static_cast<size_t>(p)];
            std::copy_n(next, piece.size(), letters.begin() + piece.first);
            next += piece.size();
        }
    }
}

}  // namespace

std::vector<int32_t> likeliest_clusters(const Mixture& model, const RowSource& rows,
                                        const Workers& workers) {
    require_dimension_of(rows.columns(), model.dimension());
    const ClusterDensities densities(model, false);
    const ClusterGroups groups(densities);
    const auto& pieces = rows.layout().pieces;
    const std::vector<int64_t> share =
        share_of_pieces(rows.layout(), workers.rank(), workers.rank_count());
    std::vector<int32_t> letters(static_cast<size_t>(rows.rows()));
    parallel_for(workers.threads, static_cast<int64_t>(share.size()), [&](int64_t i) {
        const RowRange& piece = pieces[static_cast<size_t>(share[static_cast<size_t>(i)])];
        assign(densities, groups, rows.read(piece).view(), piece.first,
               letters.data() + piece.first);
    });
    if (workers.rank_count() > 1) exchange(rows.layout(), workers, letters);
    return letters;
}

}  // namespace kinetome
