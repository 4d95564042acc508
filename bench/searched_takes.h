// Takes that are searched by signatures and by exhaustive warping.
#pragma once

#include <tbb/parallel_for.h>

#include <cmath>
#include <optional>
#include <vector>

#include "exhaustive_warp.h"
#include "kinetome/math/pca.h"
#include "kinetome/models/match_rerank.h"
#include "kinetome/models/signature_index.h"
#include "marker_takes.h"

namespace kinetome::bench {

inline constexpr double frame_rate = 120;
inline constexpr int64_t stride = 4;          // 120 to 30 Hz
inline constexpr int64_t query_frames = 240;  // 2 s
inline constexpr double overlap = 0.3;

struct Query {
    MatrixF markers;  ///< at 120 Hz
};

/// A database that is searched both ways.
class Collection {
  public:
    Collection(const std::vector<MarkerTake>& takes, const PoseHierarchy& hierarchy, int threads)
        : hierarchy_(hierarchy),
          axes_(signature_axes(hierarchy)),
          index_(index_of(takes, hierarchy, axes_, threads)) {
        Moments moments = moments_of(takes.front().markers);
        for (size_t i = 1; i < takes.size(); ++i) merge(moments, moments_of(takes[i].markers));
        // One scale for all columns: distances stay those of the markers.
        const VectorD scale = VectorD::Constant(moments.dimension(), 1e6);
        pca_ = fit_pca(moments, scale, 1);
        const Eigen::Index kept = std::min<Eigen::Index>(24, pca_.components.cols());
        pca_.components = pca_.components.leftCols(kept).eval();
        pca_.scale.setConstant(std::sqrt(double(compared_markers(moments.dimension()))) / 10);
        for (const MarkerTake& take : takes) {
            features_.push_back(features(take.markers));
            feature_rows_.push_back(features_.back().rows());
        }
        warp_.emplace(features_, stride);
    }

    int64_t runs() const { return int64_t(index_.parts().clips.values.size()); }

    /// mm per marker, at 30 Hz.
    MatrixF features(const MatrixF& markers) const {
        MatrixF rows((markers.rows() + stride - 1) / stride, markers.cols());
        for (Eigen::Index i = 0; i < rows.rows(); ++i) rows.row(i) = markers.row(i * stride);
        return pca_.project(rows);
    }

    std::vector<IndexedMatch> by_signature(const Query& query, int64_t k) const {
        return matches(query, k, true);
    }

    std::vector<IndexedMatch> by_signature_and_rerank(const Query& query, int64_t k) const {
        constexpr int64_t reranked = 60;
        auto found = matches(query, reranked, false);
        for (IndexedMatch& match : found) {
            match.match.frames = {match.match.frames.first / stride,
                                  (match.match.frames.end + stride - 1) / stride};
        }
        const auto read = [&](int32_t take, const RowRange& rows) -> MatrixF {
            return features_[size_t(take)].middleRows(rows.first, rows.size());
        };
        RerankOptions options;
        options.stride = 1;
        found = rerank_matches(features(query.markers), found, feature_rows_, k, read, options, 1);
        for (IndexedMatch& match : found) {
            match.match.frames = {match.match.frames.first * stride,
                                  match.match.frames.end * stride};
        }
        return found;
    }

    std::vector<IndexedMatch> by_warping(const Query& query, int64_t k) const {
        return warp_->search(features(query.markers), k, overlap);
    }

    /// Of the query at an answer, which may be off by a quarter of the query at either end.
    double warping_cost(const MatrixF& query, const IndexedMatch& match) const {
        const MatrixF& take = features_[size_t(match.clip)];
        constexpr int64_t margin = query_frames / 4;
        const int64_t first = std::max<int64_t>(match.match.frames.first - margin, 0) / stride;
        const int64_t end =
            std::min<int64_t>((match.match.frames.end + margin) / stride, take.rows());
        return ExhaustiveWarp::least_cost(query, take.middleRows(first, end - first));
    }

  private:
    std::vector<IndexedMatch> matches(const Query& query, int64_t k, bool to_the_frame) const {
        SignatureSearchOptions options;
        options.to_the_frame = to_the_frame;
        return index_.search(placed(query.markers, hierarchy_, axes_, 1), k, options);
    }

    static SignatureIndex index_of(const std::vector<MarkerTake>& takes,
                                   const PoseHierarchy& hierarchy, const MatrixF& axes,
                                   int threads) {
        std::vector<PlacedSignature> signatures(takes.size());
        tbb::parallel_for(size_t(0), takes.size(), [&](size_t i) {
            signatures[i] = placed(takes[i].markers, hierarchy, axes, sample_stride(frame_rate));
        });
        return SignatureIndex(signatures, positions_of(hierarchy.means, axes), {}, threads);
    }
    static PlacedSignature placed(const MatrixF& markers, const PoseHierarchy& hierarchy,
                                  const MatrixF& axes, int32_t apart) {
        return place_signature(make_signature(leaves_of(hierarchy, markers)), markers, axes, apart);
    }

    const PoseHierarchy& hierarchy_;
    MatrixF axes_;
    SignatureIndex index_;
    Pca pca_;
    std::vector<MatrixF> features_;
    std::vector<int64_t> feature_rows_;
    std::optional<ExhaustiveWarp> warp_;
};

}  // namespace kinetome::bench
