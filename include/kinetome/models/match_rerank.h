// Matches of signatures put in the order of the motions themselves.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/signature_index.h"

namespace kinetome {

struct RerankOptions {
    int64_t stride = 4;    ///< every so many frames of the query one is compared
    double margin = 0.25;  ///< share of the query by which a match may move at either end
    double overlap = 0.3;  ///< as in SignatureMatchOptions
};

/// Rows of features of some frames of a clip (frames × d).
using ReadFeatures = std::function<MatrixF(int32_t clip, const RowRange& frames)>;

/// The k nearest of the matches by dynamic time warping of features (slope_limited_steps,
/// WarpWeight::first), each moved to where the query (n × d) fits best.
/// Distances are those of the features, mean along the path. The same for any number of threads;
/// `read` is called from several.
std::vector<IndexedMatch> rerank_matches(const MatrixFView& query,
                                         const std::vector<IndexedMatch>& matches,
                                         const std::vector<int64_t>& clip_frames, int64_t k,
                                         const ReadFeatures& read, const RerankOptions& options,
                                         int threads);

}  // namespace kinetome
