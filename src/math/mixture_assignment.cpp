#include <algorithm>
#include <limits>

#include "candidate_search.h"
#include "frame_super.h"
#include "kinetome/base/parallel.h"
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

}  // namespace

std::vector<int32_t> likeliest_clusters(const Mixture& model, const MatrixFView& rows,
                                        int threads) {
    require_dimension_of(rows, model.dimension());
    const ClusterDensities densities(model, false);
    const ClusterGroups groups(densities);
    std::vector<int32_t> likeliest(static_cast<size_t>(rows.rows()));
    const int64_t pieces = (rows.rows() + piece_frames - 1) / piece_frames;
    parallel_for(threads, pieces, [&](int64_t piece) {
        FrameSuper frames(densities.dimension());
        CandidateSearch search(groups, 0.0F);
        const int64_t end = std::min((piece + 1) * piece_frames, rows.rows());
        for (int64_t first = piece * piece_frames; first < end; first += super_rows) {
            frames.load(rows, {first, std::min(first + super_rows, end)});
            search.run(frames);
            for (int64_t i = 0; i < frames.size(); ++i) {
                likeliest[static_cast<size_t>(first + i)] =
                    likeliest_of(search.candidates(i / tile_rows), densities,
                                 rows.data() + (first + i) * rows.outerStride());
            }
        }
    });
    return likeliest;
}

}  // namespace kinetome
