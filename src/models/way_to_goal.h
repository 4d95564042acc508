// The way on that a walk takes to where it is to end.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "walk_guide.h"

namespace kinetome {

struct WayToGoal {
    std::vector<Succession> successions;  ///< of the pieces after the first
    int32_t last_exit = 0;                ///< WalkStep::exit of the last step
    double excess = 0;                    ///< of all steps, added up
};

/// From a piece to a wanted node, or to one that is linked with it: with as little excess as there
/// is, and of such ways a short one (A*, led by WalkGuide::frames_to_goal, which is no bound). What
/// an exchange of pieces exceeds is asked for when the search comes there, of each at most once.
///
/// With `stuck`, one flag a piece, only ways without excess are sought, past pieces that are stuck:
/// when there is none, all that were led to become so.
std::optional<WayToGoal> find_way_to_goal(const MotionGraph& graph, const WalkGuide& guide,
                                          const WalkRequest& request, int32_t entry,
                                          std::vector<bool>* stuck);

}  // namespace kinetome
