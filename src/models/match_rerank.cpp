#include "kinetome/models/match_rerank.h"

#include <algorithm>

#include "kinetome/base/parallel.h"
#include "kinetome/math/warp.h"

namespace kinetome {
namespace {

MatrixF every(const MatrixFView& rows, int64_t stride) {
    MatrixF kept((rows.rows() + stride - 1) / stride, rows.cols());
    for (Eigen::Index i = 0; i < kept.rows(); ++i) kept.row(i) = rows.row(i * stride);
    return kept;
}

/// From one of every `stride` rows of the query to the next, along a motion of which no row is left
/// out: at most twice as fast or slow, evenly first.
std::vector<WarpStep> steps_between(int64_t stride) {
    if (stride == 1) return slope_limited_steps();
    std::vector<WarpStep> steps{{1, static_cast<int32_t>(stride)}};
    for (int64_t rows = (stride + 1) / 2; rows <= 2 * stride; ++rows) {
        if (rows != stride) steps.push_back({1, static_cast<int32_t>(rows)});
    }
    return steps;
}

/// Where around a match the query fits best; nothing where it does not fit at all.
std::vector<IndexedMatch> moved(const MatrixF& query, int64_t query_frames,
                                const IndexedMatch& match, int64_t clip_frames,
                                const ReadFeatures& read, const RerankOptions& options) {
    const auto margin = static_cast<int64_t>(options.margin * double(query_frames));
    const RowRange frames{std::max<int64_t>(match.match.frames.first - margin, 0),
                          std::min(match.match.frames.end + margin, clip_frames)};
    MatchOptions how;
    how.steps = steps_between(options.stride);
    const auto paths = warp_matches(query, read(match.clip, frames), how);
    const auto nearest = std::ranges::min_element(paths, {}, &WarpPath::mean);
    if (nearest == paths.end()) return {};
    const int64_t first = frames.first + nearest->cells.front().second;
    const int64_t behind_last = (query_frames - 1) % options.stride + 1;
    const int64_t end = frames.first + nearest->cells.back().second + behind_last;
    return {{match.clip, {{first, std::min(end, clip_frames)}, nearest->mean}}};
}

}  // namespace

std::vector<IndexedMatch> rerank_matches(const MatrixFView& query,
                                         const std::vector<IndexedMatch>& matches,
                                         const std::vector<int64_t>& clip_frames, int64_t k,
                                         const ReadFeatures& read, const RerankOptions& options,
                                         int threads) {
    const MatrixF sampled = every(query, options.stride);
    std::vector<std::vector<IndexedMatch>> found(matches.size());
    parallel_for(threads, static_cast<int64_t>(matches.size()), [&](int64_t i) {
        const IndexedMatch& match = matches[static_cast<size_t>(i)];
        found[static_cast<size_t>(i)] =
            moved(sampled, query.rows(), match, clip_frames[static_cast<size_t>(match.clip)], read,
                  options);
    });
    std::vector<IndexedMatch> all;
    for (const auto& one : found) all.insert(all.end(), one.begin(), one.end());
    return nearest_matches(std::move(all), k, options.overlap);
}

}  // namespace kinetome
