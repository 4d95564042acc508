// What matches of a query in many sequences cost at least.
#pragma once

#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"
#include "kinetome/math/warp.h"
#include "lanes.h"

namespace kinetome {

/// Subsequence dynamic time warping in the few directions in which the rows differ most, where
/// nothing is farther apart than it is; of all sequences side by side and in float, the bounds
/// being lowered by what that may round up.
class WarpBounds {
  public:
    /// The sequences are ranges of the rows.
    WarpBounds(const MatrixF& rows, std::span<const RowRange> sequences,
               std::span<const WarpStep> steps);

    /// Mean cost in each sequence, by WarpWeight::first.
    std::vector<double> of(const MatrixF& query) const;

  private:
    MatrixF projected(const MatrixF& rows) const;
    void measure(const float* row, float* distances) const;
    double lowered(float total, const MatrixF& query) const;

    std::vector<WarpStep> steps_;
    VectorD mean_;
    MatrixD axes_;                   ///< d × p
    std::vector<RowRange> columns_;  ///< of each sequence, with gaps between that no path enters
    int64_t width_ = 0;              ///< whole lanes
    LaneBuffer along_axes_;          ///< p × width_
    Eigen::ArrayXf gaps_;            ///< width_; 0 in a sequence, else infinite
    float largest_ = 0;              ///< coordinate
};

}  // namespace kinetome
