// Behaviours by probabilistic principal components (Barbič, Safonova, Pan, Faloutsos, Hodgins &
// Pollard, Segmenting Motion Capture Data into Distinct Behaviors, Graphics Interface 2004, §4):
// the peer that S3 compares itself with. A Gaussian of the frames since the last cut stops to
// expect the frames ahead where a new behaviour begins.
//
// Ours is the factor that tells a peak: the published threshold is a difference, which holds for
// the scale of that paper's features. Of 1.5, 2 and 3 it is the one that serves the peer best.
#pragma once

#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/segment.h"

namespace kinetome {

struct PpcaSegmentationOptions {
    double rate = 120;            ///< of the features, frames a second
    double window = 150.0 / 120;  ///< s: of the frames ahead, and of the first Gaussian after a cut
    double step = 10.0 / 120;     ///< s by which the Gaussian's frames grow
    double kept_variance = 0.95;  ///< share that the principal components hold; the rest is noise
    double least_rise = 3;        ///< factor from a valley of the distance to the peak that is a
                                  ///< cut, and from the peak down again
    double least_spacing = 1;     ///< s: cuts of the two directions that are nearer are one
};

/// The average squared Mahalanobis distance of `ahead` from the probabilistic principal components
/// of `known`. Both have the same columns; throws std::invalid_argument for fewer than two rows.
double distance_from_ppca(const MatrixFView& known, const MatrixFView& ahead, double kept_variance);

/// The frames at which behaviours begin, without the first, found going forward and going backward
/// through the n × d features of a take (as published: quaternions of the joints).
std::vector<int64_t> ppca_cuts(const MatrixFView& features,
                               const PpcaSegmentationOptions& options = {});

/// The behaviours between those cuts as activities. The method knows no sameness: each is a cluster
/// of its own.
std::vector<Segment> ppca_segments(const MatrixFView& features,
                                   const PpcaSegmentationOptions& options = {});

}  // namespace kinetome
