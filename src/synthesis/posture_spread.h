// How much each control of a posture varies.
#pragma once

#include "kinetome/synthesis/posture.h"

namespace kinetome {

/// One standard deviation between people; the same controls also wander while a person moves. Zero
/// where variation would lift a standing foot off its place.
Posture posture_spread();

}  // namespace kinetome
