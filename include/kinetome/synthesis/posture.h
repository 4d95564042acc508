// A posture in terms a choreographer would use, and the solver that turns it into joint angles.
#pragma once

#include <array>
#include <cstdint>

#include "kinetome/synthesis/value_table.h"

namespace kinetome {

enum class Side : uint8_t { left, right };
inline constexpr std::array<Side, 2> both_sides = {Side::left, Side::right};
constexpr Side opposite(Side side) {
    return side == Side::left ? Side::right : Side::left;
}
/// +1 for left, whose x is positive; -1 for right.
constexpr double sign_of(Side side) {
    return side == Side::left ? 1.0 : -1.0;
}

/// Trunk and travel. Lengths are shares of the leg's length, angles radians. "Left" is positive.
enum class Trunk : uint8_t {
    pelvis_height,   ///< of the hips above standing ankles; 1: legs straight
    pelvis_shift,    ///< to the left of the travelling frame
    pelvis_advance,  ///< ahead of the travelling frame
    pelvis_pitch,    ///< forward
    pelvis_yaw,      ///< towards the left
    pelvis_roll,     ///< left hip up
    spine_flexion,
    spine_twist,
    spine_lean,
    neck_flexion,
    neck_twist,
    neck_lean,
    speed,       ///< of the travelling frame, leg lengths a second, forward
    side_speed,  ///< the same to the left
    turn_rate,   ///< radians a second, towards the left
    count
};

/// Radians; the signs are anatomical, so that both arms with equal numbers mirror each other.
enum class Arm : uint8_t {
    flexion,    ///< forward and up; 0: hanging
    abduction,  ///< sideways and up
    inward,     ///< internal rotation about the upper arm
    elbow,      ///< 0: straight
    pronation,  ///< twist of the forearm
    wrist_flexion,
    wrist_deviation,
    finger_flexion,
    thumb_flexion,
    thumb_spread,
    shrug,        ///< shoulder up
    protraction,  ///< shoulder forward
    count
};

/// Where the foot is in the travelling frame; lengths are shares of the leg's length.
enum class Leg : uint8_t {
    out,  ///< from the middle line towards the leg's own side
    ahead,
    lift,      ///< of the sole above the floor
    pitch,     ///< heel up (about the ball) positive, toes up (about the heel) negative
    toe_out,   ///< the foot's heading, outward
    knee_out,  ///< turn of the knee's axis, outward
    toe_bend,  ///< toes up against the foot
    count
};

struct Posture {
    ValueTable<Trunk> trunk;
    std::array<ValueTable<Arm>, 2> arms;
    std::array<ValueTable<Leg>, 2> legs;

    double& operator[](Trunk control) { return trunk[control]; }
    double operator[](Trunk control) const { return trunk[control]; }
    ValueTable<Arm>& arm(Side side) { return arms[static_cast<size_t>(side)]; }
    const ValueTable<Arm>& arm(Side side) const { return arms[static_cast<size_t>(side)]; }
    ValueTable<Leg>& leg(Side side) { return legs[static_cast<size_t>(side)]; }
    const ValueTable<Leg>& leg(Side side) const { return legs[static_cast<size_t>(side)]; }

    Posture& operator+=(const Posture& other);
};

/// (1 - weight) · a + weight · b, every control alike.
Posture mix(const Posture& a, const Posture& b, double weight);

/// The same as seen in a mirror: sides change places, what points to the left points to the right.
Posture mirrored(const Posture& posture);

}  // namespace kinetome
