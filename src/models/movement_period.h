// After how many frames a movement recurs.
#pragma once

#include "path_costs.h"

namespace kinetome {

struct PeriodRule {
    int64_t shortest = 1;  ///< frames
    int64_t side = 0;      ///< of the path costs
    double least_dip = 0;  ///< share by which the mean cost is lower a period apart than nearer
    double same_dip = 0;   ///< of the deepest dip, that counts as being as deep
};

struct MovementPeriod {
    int64_t frames = 0;  ///< 0: the movement has none
    double dip = 0;      ///< share by which the mean cost is lower a period apart than nearer
};

/// The shortest lag at which frames are alike on the mean as at no lag before, as in pitch
/// detection by average magnitude differences. Small movements whose single frames recur no better
/// than by chance have one, being seen by all frames together; single frames that meet again within
/// a movement do not.
MovementPeriod movement_period(const FrameDistances& activity, const PeriodRule& rule);

}  // namespace kinetome
