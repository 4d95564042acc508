// Where a body stands on the floor and which way it faces: what may be changed without changing the
// motion.
#pragma once

#include <span>

#include "kinetome/features/root_motion.h"

namespace kinetome {

/// Place of the root on the floor (cm) and heading, radians about the vertical. Also a step: the
/// placement after it as seen from the one before.
struct Placement {
    double x = 0, z = 0;
    double heading = 0;
};

/// The root's rotation is a turn about the vertical after the shortest tilt: so the heading is
/// known of all poses but those upside down, lying ones among them.
Placement placement_of(const RootPose& root);

/// The step that leads from one placement to the other, the shorter way round.
Placement step_between(const Placement& from, const Placement& to);
/// Where a step leads.
Placement after_step(const Placement& from, const Placement& step);

/// Moves and turns a frame to a placement; height and tilt stay. The rest as RootChain::set_pose.
void place(const RootChain& root, std::span<float> dofs, const Placement& placement,
           std::span<const float> near);

}  // namespace kinetome
