// What takes are cut into, as a picture (`export timeline`).
#pragma once

#include "kinetome/report/timeline_svg.h"
#include "kinetome/run/generation.h"

namespace kinetome {

/// A row a take, in name order, at the effector rate; clusters of activities are each take's own.
Timeline stored_timeline(const Generation& generation);

}  // namespace kinetome
