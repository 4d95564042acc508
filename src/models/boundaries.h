// Where exactly one activity gives way to the next.
#pragma once

#include <span>

#include "kinetome/base/matrix.h"
#include "kinetome/models/activity.h"

namespace kinetome {

/// Where frames before it are likest the activity `before` and those after it likest `after`, which
/// comes later: from boundary_reach before the end of the one to as long after the first frame of
/// the other.
int64_t likeliest_boundary(const RowRange& before, const RowRange& after,
                           const MatrixFView& features, const RepetitionOptions& options,
                           double rate);

/// Moves the boundary of two activities that meet to where the frames before it are likest the one
/// and those after it likest the other. What recurs most decides that two activities differ, but
/// not to the frame where they share a posture.
void refine_boundaries(std::span<Segment> segments, const MatrixFView& features,
                       const RepetitionOptions& options, double rate);

}  // namespace kinetome
