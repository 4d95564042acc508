// The choreography of each activity. Phases are cycles, lengths shares of the leg, angles radians.
#pragma once

#include <numbers>

#include "kinetome/synthesis/activity.h"

namespace kinetome::choreography {

inline constexpr double degree = std::numbers::pi / 180;
inline constexpr double turn = 2 * std::numbers::pi;

/// Upright, feet side by side, arms hanging.
Posture standing(const Traits& traits);

/// Left foot ahead, fists up; bounces twice a cycle.
Posture guard(const Traits& traits, const Moment& moment);

Posture walk(const Traits& traits, const Moment& moment);
Posture run(const Traits& traits, const Moment& moment);
Posture jump(const Traits& traits, const Moment& moment);
/// Left side leads: a jab of the left hand, a cross of the right.
Posture punch(Side side, const Traits& traits, const Moment& moment);
Posture kick(Side side, const Traits& traits, const Moment& moment);
Posture squat(const Traits& traits, const Moment& moment);
Posture arm_circles(const Traits& traits, const Moment& moment);
Posture wave(const Traits& traits, const Moment& moment);
Posture sit(const Traits& traits, const Moment& moment);
Posture idle(const Traits& traits, const Moment& moment);

}  // namespace kinetome::choreography
