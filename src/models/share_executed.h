// How far a movement has come when the take ends.
#pragma once

#include <span>

#include "frame_distances.h"

namespace kinetome {

/// What share of the movement that begins at the last of the `starts` (at least two, ascending) has
/// been executed at the last frame of the activity. The frame most like that one, by path costs of
/// this `side`, is looked for in each execution before, no farther from where the same tempo would
/// come to than half the execution; of the shares of the executions that have come by then, the
/// lower median. More than 1 where the movement goes on past its end.
double share_executed(const FrameDistances& activity, std::span<const int64_t> starts,
                      int64_t side);

}  // namespace kinetome
