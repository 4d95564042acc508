// A radius for takes whose motion is of low amplitude (S3 §7: for brushing dust off a dustpan "the
// standard radius is too high").
#pragma once

#include "kinetome/base/matrix.h"

namespace kinetome {

struct RadiusAdaptation {
    double share = 0.75;  ///< of the median distance between frames that a radius may be
    double least = 10;    ///< not less: so far apart are equal poses, measured a centimetre off
};

/// The median distance between two frames of n × d features, the lower of two middle ones: over all
/// pairs of at most 512 frames, evenly spaced. 0 for fewer than two frames.
double median_frame_distance(const MatrixFView& features);

/// min(radius, max(least, share · median distance)): a take that moves half as far has half the
/// radius, once that is below the one given. Units of the features.
double adapted_radius(const MatrixFView& features, double radius,
                      const RadiusAdaptation& adaptation);

}  // namespace kinetome
