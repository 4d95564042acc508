// Punches and kicks from a boxer's guard, and the jump.
#include <algorithm>
#include <cmath>

#include "choreography.h"
#include "kinetome/synthesis/curve.h"

namespace kinetome::choreography {

Posture guard(const Traits& traits, const Moment& moment) {
    Posture posture = standing(traits);
    using enum Trunk;
    const double bounce = std::cos(2 * turn * moment.phase) * traits[Trait::bounce];
    posture[pelvis_height] = 0.905 + 0.010 * bounce;
    posture[pelvis_yaw] = -26 * degree;
    posture[pelvis_pitch] = 5 * degree;
    posture[spine_flexion] = 11 * degree + traits[Trait::lean];
    posture[spine_twist] = -8 * degree;
    posture[neck_twist] = 28 * degree;
    posture[neck_flexion] = 4 * degree - 0.5 * traits[Trait::lean];
    for (const Side side : both_sides) {
        const bool lead = side == Side::left;
        ValueTable<Arm>& arm = posture.arm(side);
        arm[Arm::flexion] = (lead ? 44 : 36) * degree;
        arm[Arm::abduction] = 14 * degree;
        arm[Arm::inward] = 18 * degree;
        arm[Arm::elbow] = (lead ? 108 : 120) * degree + traits[Trait::elbow];
        arm[Arm::pronation] = 12 * degree;
        arm[Arm::finger_flexion] = 70 * degree;
        arm[Arm::thumb_flexion] = 15 * degree;
        arm[Arm::shrug] = 5 * degree;
        ValueTable<Leg>& leg = posture.leg(side);
        leg[Leg::ahead] = (lead ? 0.20 : -0.22) * traits[Trait::stance];
        leg[Leg::out] = 0.15 * traits[Trait::stance];
        leg[Leg::toe_out] = (lead ? -8 : 42) * degree;
        leg[Leg::knee_out] = (lead ? 0 : 22) * degree;
        leg[Leg::pitch] = (lead ? 0 : 14) * degree;
        leg[Leg::toe_bend] = 0.8 * leg[Leg::pitch];
    }
    return posture;
}

Posture punch(Side side, const Traits& traits, const Moment& moment) {
    static const Curve extension = {{0.00, 0},    {0.12, -0.10}, {0.36, 1},
                                    {0.42, 0.97}, {0.72, 0.04},  {0.85, 0}};
    using enum Trunk;
    Posture posture = guard(traits, moment);
    const double at = extension(moment.phase - traits[Trait::arm_lag]) * traits[Trait::size];
    const double body =
        extension(moment.phase + 0.03 - traits[Trait::trunk_lag]) * traits[Trait::trunk_size];
    const double hook = traits[Trait::curl];
    const bool lead = side == Side::left;

    ValueTable<Arm>& arm = posture.arm(side);
    arm[Arm::flexion] += (86 * degree - arm[Arm::flexion]) * std::min(at, 1.1);
    arm[Arm::abduction] += (55 * hook - 10) * degree * at;
    arm[Arm::inward] += (10 + 25 * hook) * degree * at;
    arm[Arm::elbow] -= (arm[Arm::elbow] - (10 + 75 * hook) * degree) * std::min(at, 1.03);
    arm[Arm::pronation] += 60 * degree * at;
    arm[Arm::protraction] += 13 * degree * at;
    ValueTable<Arm>& other = posture.arm(opposite(side));
    other[Arm::flexion] -= 6 * degree * body;
    other[Arm::elbow] += 6 * degree * body;

    // The rear hand drives from the floor: hips turn in and the heel comes up. The lead hand only
    // turns the shoulder.
    posture[pelvis_yaw] += (lead ? -6 : 32) * degree * body;
    posture[spine_twist] += (lead ? -16 : 26) * degree * body;
    posture[neck_twist] -= (lead ? -20 : 50) * degree * body;
    posture[spine_flexion] += 5 * degree * body;
    posture[pelvis_advance] = (lead ? 0.035 : 0.06) * body;
    posture[pelvis_height] -= 0.012 * body;
    ValueTable<Leg>& rear = posture.leg(Side::right);
    rear[Leg::pitch] += (lead ? 6 : 22) * degree * std::max(0.0, body);
    rear[Leg::toe_bend] = 0.8 * rear[Leg::pitch];
    rear[Leg::toe_out] -= (lead ? 0 : 22) * degree * body;
    rear[Leg::knee_out] -= (lead ? 0 : 14) * degree * body;
    return posture;
}

Posture kick(Side side, const Traits& traits, const Moment& moment) {
    static const Curve ahead = {{0.00, -0.16}, {0.09, -0.14}, {0.25, 0.22},
                                {0.44, 1.12},  {0.62, 0.26},  {0.84, -0.16}};
    static const Curve lift = {{0.00, 0},    {0.06, 0.02}, {0.25, 0.44}, {0.44, 0.74},
                               {0.62, 0.42}, {0.74, 0.10}, {0.86, 0}};
    static const Curve pitch = {{0.00, 6 * degree},   {0.08, 42 * degree}, {0.24, 28 * degree},
                                {0.44, -50 * degree}, {0.62, 22 * degree}, {0.75, 14 * degree},
                                {0.87, 6 * degree}};
    static const Curve weight = {{0.00, 0}, {0.12, 1}, {0.66, 1}, {0.88, 0}};
    static const Curve thrust = {{0.00, 0}, {0.22, 0.1}, {0.44, 1}, {0.66, 0.1}};
    using enum Trunk;
    const double sign = sign_of(side);
    const double phase = moment.phase;
    const double on_support = weight(phase);
    const double out = thrust(phase) * traits[Trait::trunk_size];
    Posture posture = guard(traits, {0, moment.rate});
    posture[pelvis_yaw] = sign * (26 - 36 * out) * degree;
    posture[spine_twist] = sign * (6 + 12 * out) * degree;
    posture[neck_twist] = -0.85 * (posture[pelvis_yaw] + posture[spine_twist]);
    posture[pelvis_shift] = -sign * 0.10 * on_support;
    posture[pelvis_advance] = 0.10 * on_support;
    posture[pelvis_height] = 0.90 + 0.035 * on_support * traits[Trait::bounce];
    posture[pelvis_pitch] = (5 - 22 * out) * degree;
    posture[pelvis_roll] = sign * 5 * degree * on_support;
    posture[spine_flexion] += 8 * degree * out;
    posture[spine_lean] = -sign * 6 * degree * on_support;

    ValueTable<Leg>& leg = posture.leg(side);
    leg[Leg::ahead] = ahead(phase);
    leg[Leg::lift] = lift(phase) * traits[Trait::size];
    leg[Leg::out] = 0.13 - 0.05 * on_support + 0.10 * traits[Trait::curl] * out;
    leg[Leg::pitch] = pitch(phase);
    leg[Leg::toe_out] = 14 * degree;
    leg[Leg::knee_out] = 10 * degree;
    leg[Leg::toe_bend] = 12 * degree * out;
    ValueTable<Leg>& support = posture.leg(opposite(side));
    support[Leg::ahead] = 0.14;
    support[Leg::out] = 0.12;
    support[Leg::pitch] = 0;
    support[Leg::toe_bend] = 0;
    support[Leg::toe_out] = (12 + 14 * on_support) * degree;
    support[Leg::knee_out] = 8 * degree;
    for (const Side hand : both_sides) {
        const double away = hand == side ? 1 : 0.35;
        ValueTable<Arm>& arm = posture.arm(hand);
        arm[Arm::flexion] -= 42 * degree * away * out * traits[Trait::arm_size];
        arm[Arm::elbow] -= 55 * degree * away * out * traits[Trait::arm_size];
        arm[Arm::abduction] += 16 * degree * out;
    }
    return posture;
}

namespace {

constexpr double crouch_end = 0.24;
constexpr double take_off = 0.38;
constexpr double landing = 0.62;
constexpr double landed = 0.76;
constexpr double usual_leg_metres = 0.85;  // only turns gravity into leg lengths

struct Height {
    double hips;      ///< above their standing height, leg lengths
    double airborne;  ///< of that, above the take-off height
};

/// Crouch, push off, fly as gravity demands for the time in the air, land, stand up.
Height jump_height(double at, double depth, double rate) {
    const double air_seconds = (landing - take_off) / rate;
    const double apex = 9.81 * air_seconds * air_seconds / 8 / usual_leg_metres;
    const double rise = 0.12;                              // toes stretched at take-off
    const double speed = 4 * apex / (landing - take_off);  // leg lengths a cycle
    const auto between = [&](double from, double to) { return (at - from) / (to - from); };
    if (at < crouch_end) return {hermite(between(0, crouch_end), 0, -depth, 0, 0), 0};
    if (at < take_off) {
        const double width = take_off - crouch_end;
        return {hermite(between(crouch_end, take_off), -depth, rise, 0, speed * width), 0};
    }
    if (at < landing) {
        const double x = between(take_off, landing);
        const double flown = 4 * apex * x * (1 - x);
        return {rise + flown, flown};
    }
    const double sink = 0.7 * depth;
    if (at < landed) {
        const double width = landed - landing;
        return {hermite(between(landing, landed), rise, -sink, -speed * width, 0), 0};
    }
    return {hermite(between(landed, 1), -sink, 0, 0, 0), 0};
}

}  // namespace

Posture jump(const Traits& traits, const Moment& moment) {
    static const Curve swing = {{0.00, 0},    {0.20, -0.42}, {0.40, 1},
                                {0.52, 1.05}, {0.70, 0.25},  {0.86, 0.02}};
    static const Curve heel = {{0.00, 0},           {0.24, 0},           {0.38, 48 * degree},
                               {0.48, 52 * degree}, {0.61, 30 * degree}, {0.69, 0}};
    using enum Trunk;
    const double at = fraction(moment.phase);
    const double depth = 0.24 * traits[Trait::size];
    const Height height = jump_height(at, depth, moment.rate);
    const double crouch = std::max(0.0, -height.hips);
    const double trunk = traits[Trait::trunk_size];
    const double in_air = at > take_off && at < landing
                              ? std::sin(turn / 2 * (at - take_off) / (landing - take_off))
                              : 0.0;
    Posture posture = standing(traits);
    posture[pelvis_height] = 0.985 + height.hips;
    posture[pelvis_advance] = -0.35 * crouch;
    posture[pelvis_pitch] += 85 * degree * crouch * trunk;
    posture[spine_flexion] += 75 * degree * crouch * trunk - 4 * degree * in_air;
    posture[neck_flexion] -= 55 * degree * crouch * trunk;
    posture[speed] = 1.4 * traits[Trait::curl] * in_air * in_air;
    posture[turn_rate] = traits[Trait::turn] * in_air * in_air;
    const double arms =
        swing(moment.phase - traits[Trait::arm_lag]) * std::min(1.25, traits[Trait::arm_size]);
    for (const Side side : both_sides) {
        ValueTable<Arm>& arm = posture.arm(side);
        arm[Arm::flexion] += 105 * degree * arms;
        arm[Arm::elbow] += 28 * degree * arms * arms;
        arm[Arm::abduction] += 8 * degree * arms * arms;
        arm[Arm::shrug] = 8 * degree * std::max(0.0, arms);
        ValueTable<Leg>& leg = posture.leg(side);
        leg[Leg::lift] = height.airborne + 0.10 * traits[Trait::curl] * in_air * in_air;
        leg[Leg::pitch] = heel(at);
        leg[Leg::toe_bend] = 0.8 * leg[Leg::pitch] * (1 - in_air);
        leg[Leg::knee_out] = (6 + 30 * crouch) * degree;
    }
    return posture;
}

}  // namespace kinetome::choreography
