// Signatures that know where their runs lie, so that motions are compared by more than which leaves
// they pass through: two motions of one leaf still differ along its components (S2 §5.3).
#pragma once

#include <algorithm>
#include <cstdint>

#include "kinetome/base/matrix.h"
#include "kinetome/models/pose_hierarchy.h"
#include "kinetome/models/signature.h"

namespace kinetome {

/// r: of poses of f columns.
int64_t signature_axis_count(int64_t columns);

/// f × r: what poses (cm) are multiplied by for positions, whose Euclidean distances are
/// those between poses in mm per marker, the origin among the f / 3 markers. The r directions in
/// which the poses of a hierarchy differ most; along the others they hardly do.
MatrixF signature_axes(const PoseHierarchy& hierarchy);

/// Of poses (n × f, cm), n × r.
MatrixF positions_of(const MatrixDView& poses, const MatrixF& axes);

/// Frames of a motion whose positions are kept: every `stride`-th from 0, and the last.
struct FrameSamples {
    int64_t frames = 0;  ///< of the motion
    int32_t stride = 1;

    int64_t count() const;
    int64_t frame(int64_t sample) const { return std::min(sample * stride, frames - 1); }
};

/// Stride of samples a fifteenth of a second apart.
int32_t sample_stride(double frame_rate);

/// Positions (count × r) at `first`, `first + spacing` and so on, in frames, between those of
/// samples (n × r): cubic, with tangents parallel to the line between the samples on either side.
/// Before frame 0 and after the last they are those of these two.
MatrixF positions_between(const MatrixFView& positions, const FrameSamples& samples, double first,
                          double spacing, int64_t count);

/// n runs and where they lie, and m samples of the way through them.
struct PlacedSignature {
    Signature runs;
    MatrixF positions;         ///< n × r, of the mean poses of runs
    int32_t stride = 1;        ///< of the samples
    MatrixF sample_positions;  ///< m × r, of single poses

    FrameSamples samples() const { return {frame_count(runs), stride}; }
};

/// Of a motion's poses (frames × f, cm). Throws std::invalid_argument when the signature has not as
/// many frames as there are poses, for a stride that is not positive, and for a pose that is not
/// finite, naming the run it is in.
PlacedSignature place_signature(Signature signature, const MatrixFView& poses, const MatrixF& axes,
                                int32_t stride);

}  // namespace kinetome
