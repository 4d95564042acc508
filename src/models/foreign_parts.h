// What the cuts of a take leave together that does not belong together.
#pragma once

#include <vector>

#include "kinetome/models/activity.h"
#include "recurrence.h"
#include "repetition_cuts.h"

namespace kinetome {

/// Cuts a segment where its two parts hardly ever meet and one of them repeats, until there is no
/// such segment: cuts that repeat most leave a movement that happens once with one next to it that
/// repeats little, since the latter loses less by it than a segment costs.
std::vector<ScoredSegment> without_foreign_parts(const std::vector<ScoredSegment>& segments,
                                                 const Recurrence& recurrence,
                                                 const RepetitionOptions& options, double rate);

}  // namespace kinetome
