// Distances between the frames of a take.
#pragma once

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"

namespace kinetome {

using RowVectorF = Eigen::RowVectorXf;

/// Some consecutive frames of a take, numbered from the first of them, made ready for their
/// distances to each other.
class FrameDistances {
  public:
    /// `features` are the n × d rows of the take.
    FrameDistances(const MatrixFView& features, const RowRange& frames)
        : columns_(features.middleRows(frames.first, frames.size()).transpose()) {}

    int64_t size() const { return columns_.cols(); }

    /// Sets `distances` to those from one frame to each.
    void from(int64_t frame, Eigen::Ref<RowVectorF> distances) const;

  private:
    MatrixF columns_;  // d × frames: sums run over all frames at once, feature by feature
};

}  // namespace kinetome
