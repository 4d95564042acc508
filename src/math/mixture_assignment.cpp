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

}  // namespace

std::vector<int32_t> likeliest_clusters(const Mixture& model, const RowSource& rows,
                                        const Workers& workers) {
    require_dimension_of(rows.columns(), model.dimension());
    const ClusterDensities densities(model, false);
    const ClusterGroups groups(densities);
    const auto& pieces = rows.layout().pieces;
    const RowRange share = share_of_pieces(rows.layout(), workers.rank(), workers.rank_count());
    const int64_t first_row = share.size() ? pieces[size_t(share.first)].first : 0;
    const int64_t end_row = share.size() ? pieces[size_t(share.end - 1)].end : 0;
    std::vector<int32_t> mine(static_cast<size_t>(end_row - first_row));
    parallel_for(workers.threads, share.size(), [&](int64_t i) {
        const RowRange& piece = pieces[static_cast<size_t>(share.first + i)];
        assign(densities, groups, rows.read(piece).view(), piece.first,
               mine.data() + (piece.first - first_row));
    });
    if (workers.rank_count() == 1) return mine;

    std::vector<int32_t> all;
    for (std::string& part : workers.ranks->gather_to_all(packed(mine))) {
        const auto letters = unpacked<std::vector<int32_t>>(std::move(part));
        all.insert(all.end(), letters.begin(), letters.end());
    }
    return all;
}

}  // namespace kinetome
