// The frames around the boundary of two activities that belong to neither.
#pragma once

#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/activity.h"
#include "recurrence.h"

namespace kinetome {

/// Puts a transition between activities that meet where frames on either side are far from all
/// that their own activity does at another time. Where they are not far from what the other one
/// does, the boundary of the two lies elsewhere, and is moved there instead.
std::vector<Segment> with_transitions(const std::vector<Segment>& segments,
                                      const MatrixFView& features, const Recurrence& recurrence,
                                      const RepetitionOptions& options, double rate);

}  // namespace kinetome
