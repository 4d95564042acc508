// For 16 frames at a time, the clusters that can matter to any of them: the dense part of the
// E step. A candidate's density is evaluated anew where it counts, from differences; the search
// itself uses expanded products, which are fused multiply-adds and nothing else.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "frame_super.h"
#include "kinetome/math/mixture.h"

namespace kinetome {

/// ln density of cluster k at y is offset_k + slope_k |y - μ_k|².
struct ClusterDensities {
    /// With the mixing weight (ln π_k in the offset) or without. Throws std::invalid_argument when
    /// the shapes of the model differ or a variance or weight is not positive and finite.
    ClusterDensities(const Mixture& mixture, bool weighted);

    int64_t clusters() const { return means.rows(); }
    int64_t dimension() const { return means.cols(); }

    const MatrixD& means;  ///< of the mixture given, which must outlive this
    std::vector<double> offsets;
    std::vector<double> slopes;
};

/// The clusters of a model as float rows about any centre, made for the search. Six to a group;
/// what fills the last group has no density.
class ClusterGroups {
  public:
    static constexpr int group_size = 6;
    static constexpr int group_stride = 8;  ///< a group's entries, padded to a vector

    explicit ClusterGroups(const ClusterDensities& densities);

    int64_t dimension() const { return dimension_; }
    int64_t clusters() const { return clusters_; }
    int64_t count() const { return count_; }
    /// Floats of one packed group.
    int64_t packed_size() const { return (dimension_ + 2) * group_stride; }
    /// (d + 2) × 8: -2 slope (μ - c), slope, offset + slope |μ - c|² of each cluster.
    void pack(int64_t group, std::span<const float> centre, float* packed) const;

    float largest_slope() const { return largest_slope_; }    ///< magnitude
    float largest_offset() const { return largest_offset_; }  ///< magnitude

  private:
    int64_t dimension_;
    int64_t clusters_;
    int64_t count_;
    // A mean is the sum of two floats, so that its difference to a centre is good to a float's
    // precision however far both are from the origin. Groups × d × 8.
    LaneBuffer high_, low_;
    LaneBuffer slopes_, offsets_;  ///< groups × 8
    float largest_slope_ = 0;
    float largest_offset_ = 0;
};

class CandidateSearch {
  public:
    /// Finds every cluster whose ln density at some frame of the tile is within `within` of the
    /// frame's largest; a few more may be listed.
    CandidateSearch(const ClusterGroups& groups, float within);

    void run(const FrameSuper& frames);

    /// Ascending. Of the super last searched.
    std::span<const int32_t> candidates(int64_t tile) const {
        return candidates_[static_cast<size_t>(tile)];
    }

  private:
    void reset(const FrameSuper& frames);
    void scan_strip(const FrameSuper& frames, int64_t strip, int64_t first_group,
                    int64_t group_count);
    void list_candidates(int64_t strip, int64_t group,
                         const Lanes (&density)[ClusterGroups::group_size][strip_vectors]);
    /// No density is above another there: every cluster is a candidate.
    void list_all_where_products_overflow(const FrameSuper& frames);

    /// Largest density found at each frame of a strip, and what a candidate must exceed.
    struct Bar {
        Lanes largest[strip_vectors];
        Lanes least[strip_vectors];
        float below = 0;  ///< `within` and the rounding of the products
    };

    const ClusterGroups& groups_;
    int64_t dimension_;
    float within_;
    LaneBuffer packed_;
    std::vector<Bar, Eigen::aligned_allocator<Bar>> bars_;
    std::vector<std::vector<int32_t>> candidates_;
};

}  // namespace kinetome
