// Which activities of a take are the same.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/models/segment.h"
#include "recurrence.h"

namespace kinetome {

/// Numbers the activities by cluster: two are the same when weight is nearly as dense between them
/// as within them, A_xy >= least_sameness · √(A_xx A_yy), A being the mean weight of a pair of
/// frames; and so is what a chain of such pairs joins. Within, a frame also meets itself, with
/// weight 1: l and m cycles of one movement then have a ratio of 1, whatever l and m, and what
/// happens once is not the same as all that it ever meets. Clusters are numbered as they appear.
void cluster_activities(std::span<Segment> segments, const Recurrence& recurrence,
                        double least_sameness);

/// As cluster_activities, and neighbours that turn out the same become one, until there are none.
std::vector<Segment> joined_activities(std::vector<Segment> segments, const Recurrence& recurrence,
                                       double least_sameness);

}  // namespace kinetome
