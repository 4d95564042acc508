// Clips at another rate.
#pragma once

#include <cstdint>
#include <span>

#include "kinetome/formats/clip.h"

namespace kinetome {

/// The clip at `rate` frames a second; its first frame is the clip's first, nothing is
/// extrapolated. Rows that fall on a source frame are that frame, bit for bit: so are all rows at
/// an equal rate or at one that divides it (120 → 30 picks every fourth). Between two frames
/// it is as PoseInterpolation (pose_interpolation.h) has it. Throws std::invalid_argument unless
/// the rate is positive and finite.
Clip resample(const Clip& clip, double rate);

/// The clip at any moments: row i is the clip at source_frames[i], between two frames as resample
/// does it. `rate` is what the result states. Throws std::invalid_argument for a moment before the
/// first or after the last frame.
Clip sample(const Clip& clip, std::span<const double> source_frames, double rate);

/// Rows that resample gives for `frames` frames.
int64_t resampled_frames(int64_t frames, double from_rate, double to_rate);

/// Where in the source a row of a resampled clip lies, in frames, not rounded.
double source_frame(int64_t row, double from_rate, double to_rate);

}  // namespace kinetome
