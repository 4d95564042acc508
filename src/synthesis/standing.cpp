// Activities that stay on the spot with both feet down: idle, arm circles, wave, squat, sit.
#include <algorithm>
#include <cmath>

#include "choreography.h"
#include "kinetome/synthesis/curve.h"

namespace kinetome::choreography {

Posture standing(const Traits& traits) {
    Posture posture;
    using enum Trunk;
    posture[pelvis_height] = 0.985;
    posture[pelvis_pitch] = 3 * degree;
    posture[spine_flexion] = 2 * degree + traits[Trait::lean];
    posture[neck_flexion] = 4 * degree - 0.7 * traits[Trait::lean];
    for (const Side side : both_sides) {
        ValueTable<Arm>& arm = posture.arm(side);
        arm[Arm::flexion] = 3 * degree;
        arm[Arm::abduction] = 10 * degree;
        arm[Arm::inward] = 12 * degree;
        arm[Arm::elbow] = 16 * degree + traits[Trait::elbow];
        arm[Arm::pronation] = 15 * degree;
        arm[Arm::finger_flexion] = 22 * degree;
        ValueTable<Leg>& leg = posture.leg(side);
        leg[Leg::out] = 0.13 * traits[Trait::stance];
        leg[Leg::toe_out] = 9 * degree;
        leg[Leg::knee_out] = 6 * degree;
    }
    return posture;
}

Posture idle(const Traits& traits, const Moment& moment) {
    // Two periods without a common multiple: weight that wanders rather than swings.
    Posture posture = standing(traits);
    using enum Trunk;
    const double slow = std::sin(turn * moment.phase);
    const double slower = std::sin(turn * 0.618 * moment.phase + 1);
    const double breath = std::sin(turn * 1.7 * moment.phase);
    const double size = traits[Trait::size];
    const double weight = size * (0.6 * slow + 0.4 * slower);  // on the left leg when positive
    posture[pelvis_shift] = 0.055 * weight;
    posture[pelvis_roll] = 3 * degree * weight;
    posture[pelvis_height] -= 0.012 * weight * weight;
    posture[pelvis_yaw] = 4 * degree * size * slower;
    posture[spine_lean] = -2.5 * degree * weight;
    posture[spine_twist] = 5 * degree * traits[Trait::trunk_size] * slow * slower;
    posture[spine_flexion] += 0.8 * degree * breath;
    posture[neck_twist] = 16 * degree * traits[Trait::trunk_size] * slower;
    posture[neck_flexion] += 5 * degree * size * slow * slower;
    for (const Side side : both_sides) {
        ValueTable<Arm>& arm = posture.arm(side);
        arm[Arm::flexion] += 4 * degree * traits[Trait::arm_size] * (slower + sign_of(side) * slow);
        arm[Arm::shrug] = 1 * degree * breath;
        const double crossed = 0.5 * (1 + slower) * traits[Trait::curl];
        arm[Arm::elbow] += 75 * degree * crossed;
        arm[Arm::inward] += 40 * degree * crossed;
        arm[Arm::flexion] += 12 * degree * crossed;
    }
    return posture;
}

Posture arm_circles(const Traits& traits, const Moment& moment) {
    // Large circles beside the body, or small ones of arms held out sideways.
    const bool large = traits[Trait::curl] < 0.5;
    const double size = traits[Trait::size];
    Posture posture = standing(traits);
    using enum Trunk;
    for (const Side side : both_sides) {
        ValueTable<Arm>& arm = posture.arm(side);
        const double lag = side == Side::left ? traits[Trait::skew] : 0;
        // A whole turn is taken back in the middle of the cycle, where no blend can unwind it.
        const double at = fraction(moment.phase + 0.5) - 0.5 - lag;
        const double c = std::cos(turn * at), s = std::sin(turn * at);
        arm[Arm::flexion] = large ? turn * at + 0.15 * std::sin(turn * at) : 40 * degree * s * size;
        arm[Arm::abduction] =
            large ? (18 - 6 * c) * degree * traits[Trait::arm_size] : (72 - 30 * c * size) * degree;
        // Flesh undoes what the circle twists: the upper arm turns once about itself, mostly while
        // it is up, so that no cycle leaves the shoulder wound up.
        arm[Arm::inward] = 10 * degree * c + (large ? turn * at - std::sin(turn * at) : 0);
        arm[Arm::elbow] =
            14 * degree + 0.5 * std::max(-8 * degree, traits[Trait::elbow]) + 6 * degree * s;
        arm[Arm::pronation] = 20 * degree - 15 * degree * c;
        arm[Arm::shrug] = 8 * degree * (0.5 - 0.5 * c);
        arm[Arm::protraction] = 6 * degree * s;
    }
    const double c = std::cos(turn * moment.phase), s = std::sin(turn * moment.phase);
    const double trunk = traits[Trait::trunk_size];
    posture[pelvis_height] += 0.008 * traits[Trait::bounce] * (c - 1);
    posture[pelvis_advance] = -0.015 * trunk * s;
    posture[spine_flexion] += 4 * degree * trunk * s;
    posture[neck_flexion] -= 2 * degree * trunk * s;
    return posture;
}

Posture wave(const Traits& traits, const Moment& moment) {
    Posture posture = standing(traits);
    using enum Trunk;
    const double swing = std::sin(turn * moment.phase);
    const double lagged = std::sin(turn * (moment.phase - 0.12));
    const double size = traits[Trait::size];
    ValueTable<Arm>& arm = posture.arm(Side::right);
    const double high = traits[Trait::curl];
    arm[Arm::flexion] = 18 * degree + 20 * degree * high;
    arm[Arm::abduction] = 58 * degree + 45 * degree * high + 5 * degree * swing;
    arm[Arm::inward] = -82 * degree + 22 * degree * size * swing;
    arm[Arm::elbow] =
        88 * degree - 45 * degree * high + traits[Trait::elbow] + 12 * degree * size * lagged;
    arm[Arm::pronation] = 25 * degree + 8 * degree * lagged;
    arm[Arm::wrist_deviation] = 16 * degree * size * lagged;
    arm[Arm::finger_flexion] = 8 * degree;
    arm[Arm::shrug] = 10 * degree;
    const double trunk = traits[Trait::trunk_size];
    posture[spine_lean] = 3 * degree + 1.5 * degree * trunk * swing;
    posture[pelvis_shift] = 0.02 * trunk * std::sin(turn * moment.phase / 4);
    posture[pelvis_roll] = 1.5 * degree * trunk * std::sin(turn * moment.phase / 4);
    posture[neck_lean] = -3 * degree * trunk * lagged;
    posture[neck_twist] = -6 * degree;
    return posture;
}

Posture squat(const Traits& traits, const Moment& moment) {
    static const Curve descent = {{0.00, 0}, {0.06, 0.01}, {0.42, 1}, {0.52, 1}, {0.90, 0.01}};
    Posture posture = standing(traits);
    using enum Trunk;
    const double depth = descent(moment.phase) * std::min(1.25, traits[Trait::size]);
    const double trunk = traits[Trait::trunk_size];
    posture[pelvis_height] -= 0.40 * depth;
    posture[pelvis_advance] = -0.15 * depth;
    posture[pelvis_pitch] += 22 * degree * depth * trunk;
    posture[spine_flexion] += 20 * degree * depth * trunk;
    posture[neck_flexion] -= 22 * degree * depth * trunk;
    const double lagged = descent(moment.phase - traits[Trait::arm_lag]);
    for (const Side side : both_sides) {
        ValueTable<Arm>& arm = posture.arm(side);
        arm[Arm::flexion] += 78 * degree * lagged * traits[Trait::arm_size];
        arm[Arm::elbow] += (60 * traits[Trait::curl] - 6) * degree * lagged;
        arm[Arm::inward] += 25 * degree * traits[Trait::curl] * lagged;
        arm[Arm::pronation] += 25 * degree * lagged;
        ValueTable<Leg>& leg = posture.leg(side);
        leg[Leg::out] *= 1.25;
        leg[Leg::toe_out] = 16 * degree;
        leg[Leg::knee_out] = (10 + 12 * depth) * degree;
        leg[Leg::pitch] = 10 * degree * depth * traits[Trait::curl];
    }
    return posture;
}

Posture sit(const Traits& traits, const Moment& moment) {
    static const Curve down = {{0.00, 0}, {0.05, 0.01}, {0.26, 1}, {0.74, 1}, {0.95, 0.01}};
    static const Curve back = {{0.00, 0}, {0.03, 0}, {0.23, 1}, {0.78, 1}, {0.94, 0}};
    static const Curve bow = {{0.00, 0},   {0.05, 0.15}, {0.18, 1}, {0.32, 0.1},
                              {0.50, 0.2}, {0.67, 0.12}, {0.79, 1}, {0.90, 0.4}};
    static const Curve at_rest = {{0.00, 0}, {0.12, 0}, {0.34, 1}, {0.64, 1}, {0.80, 0}};
    Posture posture = standing(traits);
    using enum Trunk;
    const double seated = down(moment.phase);
    const double rest = at_rest(moment.phase);
    const double trunk = traits[Trait::trunk_size];
    const double fidget = std::sin(turn * 3 * moment.phase);
    posture[pelvis_height] -= (0.41 + 0.06 * (traits[Trait::size] - 1)) * seated;
    posture[pelvis_advance] = -0.45 * back(moment.phase);
    posture[pelvis_pitch] += (15 * bow(moment.phase) - 10 * rest) * degree * trunk;
    posture[spine_flexion] += (14 * bow(moment.phase) + 8 * rest) * degree * trunk;
    posture[spine_twist] = 8 * degree * rest * fidget * traits[Trait::arm_size];
    posture[neck_flexion] -= 8 * degree * bow(moment.phase) * trunk;
    posture[neck_twist] = 18 * degree * rest * fidget;
    for (const Side side : both_sides) {
        ValueTable<Arm>& arm = posture.arm(side);
        arm[Arm::flexion] +=
            (22 * bow(moment.phase) + 20 * rest) * degree * traits[Trait::arm_size];
        arm[Arm::elbow] += (22 * bow(moment.phase) + 38 * rest) * degree +
                           30 * degree * traits[Trait::curl] * rest;
        arm[Arm::inward] += 22 * degree * rest * (0.5 + traits[Trait::curl]);
        arm[Arm::pronation] += 25 * degree * rest;
        ValueTable<Leg>& leg = posture.leg(side);
        leg[Leg::knee_out] = (6 + 8 * seated) * degree;
    }
    return posture;
}

}  // namespace kinetome::choreography
