// Walking and running.
#include <algorithm>
#include <cmath>

#include "choreography.h"
#include "kinetome/synthesis/curve.h"

namespace kinetome::choreography {
namespace {

/// What tells one gait from another.
struct Gait {
    double stride;       ///< leg lengths a cycle
    double duty;         ///< share of the cycle a foot is on the floor
    double landing;      ///< where the middle of the stance is, ahead of the hips
    double width;        ///< between the feet
    double follow;       ///< of the floor's speed, what a foot has as it leaves and as it lands
    const Curve& pitch;  ///< of the foot, from its landing on
    const Curve& lift;   ///< of the sole, from its landing on
};

/// A foot on the floor stays where it is while the travelling frame moves on and turns: seen from
/// that frame it glides back and swings round.
void place_foot(ValueTable<Leg>& leg, Side side, const Gait& gait, double phase,
                const Traits& traits, double rate) {
    const double at = fraction(phase);
    const double reach = gait.stride * gait.duty / 2;
    double ahead = 0;
    if (at < gait.duty) {
        ahead = reach - gait.stride * at;
    } else {
        const double swing = 1 - gait.duty;
        const double slope = -gait.follow * gait.stride * swing;
        ahead = hermite((at - gait.duty) / swing, -reach, reach, slope, slope);
    }
    const double turned = traits[Trait::turn] * ahead / (gait.stride * rate);
    leg[Leg::ahead] = gait.landing + ahead;
    leg[Leg::out] = gait.width * traits[Trait::stance] / 2 + sign_of(side) * ahead * turned / 2;
    leg[Leg::toe_out] = 6 * degree + sign_of(side) * turned;
    leg[Leg::lift] = gait.lift(at);
    leg[Leg::pitch] = gait.pitch(at);
    const double released = smooth_step((at - gait.duty) / 0.12);
    leg[Leg::toe_bend] = (0.6 - 0.4 * released) * std::max(0.0, leg[Leg::pitch]);
    leg[Leg::knee_out] = 4 * degree;
}

/// Arms swing against the legs; `lean` and `twist` are the trunk's.
void swing_arms(Posture& posture, const Traits& traits, double phase, double middle, double extent,
                double elbow, double elbow_extent) {
    for (const Side side : both_sides) {
        ValueTable<Arm>& arm = posture.arm(side);
        const double swing = -sign_of(side) * std::cos(turn * (phase - traits[Trait::arm_lag]));
        const double size = traits[Trait::arm_size] * (1 + sign_of(side) * traits[Trait::skew]);
        arm[Arm::flexion] = middle + extent * size * swing;
        arm[Arm::abduction] = 9 * degree;
        arm[Arm::inward] = 12 * degree;
        arm[Arm::elbow] = elbow + traits[Trait::elbow] + elbow_extent * size * swing;
        arm[Arm::pronation] = 15 * degree + 6 * degree * swing;
        arm[Arm::wrist_flexion] = -4 * degree * swing;
        arm[Arm::finger_flexion] = 25 * degree;
        arm[Arm::protraction] = 4 * degree * size * swing;
    }
}

/// Pelvis and trunk turn against each other, the head looks ahead.
void swing_trunk(Posture& posture, const Traits& traits, double phase, double yaw, double roll,
                 double twist) {
    using enum Trunk;
    const double lagged = phase - traits[Trait::trunk_lag];
    const double size = traits[Trait::trunk_size];
    posture[pelvis_yaw] = -yaw * size * std::cos(turn * phase);
    posture[pelvis_roll] = -roll * size * std::sin(turn * phase);
    posture[spine_twist] = twist * size * std::cos(turn * lagged);
    posture[spine_lean] = -0.6 * posture[pelvis_roll];
    posture[neck_twist] = -0.8 * (posture[pelvis_yaw] + posture[spine_twist]);
    posture[neck_lean] = -0.5 * (posture[pelvis_roll] + posture[spine_lean]);
}

}  // namespace

Posture walk(const Traits& traits, const Moment& moment) {
    static const Curve pitch = {{0.00, -22 * degree}, {0.09, 0},           {0.36, 0},
                                {0.50, 18 * degree},  {0.62, 56 * degree}, {0.72, 38 * degree},
                                {0.84, -4 * degree},  {0.95, -21 * degree}};
    static const Curve lift = {{0.00, 0}, {0.58, 0}, {0.70, 0.06}, {0.82, 0.035}, {0.96, 0.004}};
    const double stride = 1.28 * traits[Trait::size];
    const Gait gait = {.stride = stride,
                       .duty = 0.62,
                       .landing = 0,
                       .width = 0.21,
                       .follow = 1,
                       .pitch = pitch,
                       .lift = lift};
    using enum Trunk;
    Posture posture;
    const double phase = moment.phase;
    const double reach = stride * gait.duty / 2;
    // At double support both legs are slanted: the longer the stride, the lower the hips.
    const double low = std::min(0.960, std::sqrt(std::max(0.5, 0.995 - reach * reach)));
    const double rise = 0.022 * traits[Trait::bounce];
    posture[pelvis_height] = low + rise - rise * std::cos(2 * turn * (phase - 0.06));
    posture[pelvis_shift] = 0.022 * std::sin(turn * (phase - 0.05));
    posture[pelvis_advance] = 0.012 * std::sin(2 * turn * phase);
    posture[pelvis_pitch] = 4 * degree + 0.4 * traits[Trait::lean];
    posture[speed] = stride * moment.rate;
    posture[turn_rate] = traits[Trait::turn];
    swing_trunk(posture, traits, phase, 5 * degree, 3.5 * degree, 10 * degree);
    posture[spine_flexion] =
        3 * degree + 0.6 * traits[Trait::lean] + 1.5 * degree * std::cos(2 * turn * phase);
    posture[neck_flexion] = 4 * degree - 0.5 * traits[Trait::lean];
    swing_arms(posture, traits, phase, 2 * degree, 19 * degree, 22 * degree, 10 * degree);
    for (const Side side : both_sides) {
        const double offset = side == Side::left ? 0 : 0.5;
        place_foot(posture.leg(side), side, gait, phase + offset, traits, moment.rate);
    }
    return posture;
}

Posture run(const Traits& traits, const Moment& moment) {
    static const Curve pitch = {{0.00, -8 * degree}, {0.06, 0},           {0.18, 4 * degree},
                                {0.36, 58 * degree}, {0.52, 82 * degree}, {0.74, 25 * degree},
                                {0.94, -8 * degree}};
    static const Curve lift = {{0.00, 0},    {0.32, 0},    {0.44, 0.16},
                               {0.58, 0.33}, {0.74, 0.22}, {0.90, 0.045}};
    const double stride = 1.80 * traits[Trait::size];
    const Gait gait = {.stride = stride,
                       .duty = 0.37,
                       .landing = 0.01,
                       .width = 0.15,
                       .follow = 0.5,
                       .pitch = pitch,
                       .lift = lift};
    using enum Trunk;
    Posture posture;
    const double phase = moment.phase;
    posture[pelvis_height] =
        0.90 - 0.03 * traits[Trait::bounce] * std::cos(2 * turn * (phase - 0.17));
    posture[pelvis_shift] = 0.012 * std::sin(turn * (phase - 0.05));
    posture[pelvis_pitch] = 8 * degree + 0.5 * traits[Trait::lean];
    posture[speed] = stride * moment.rate;
    posture[turn_rate] = traits[Trait::turn];
    swing_trunk(posture, traits, phase, 8 * degree, 4 * degree, 17 * degree);
    posture[spine_flexion] =
        7 * degree + 0.8 * traits[Trait::lean] + 3 * degree * std::cos(2 * turn * (phase - 0.2));
    posture[neck_flexion] = -4 * degree - 0.8 * traits[Trait::lean];
    swing_arms(posture, traits, phase, -4 * degree, 32 * degree, 82 * degree, 14 * degree);
    for (const Side side : both_sides) {
        posture.arm(side)[Arm::inward] = 25 * degree;
        posture.arm(side)[Arm::finger_flexion] = 50 * degree;
        const double offset = side == Side::left ? 0 : 0.5;
        place_foot(posture.leg(side), side, gait, phase + offset, traits, moment.rate);
    }
    return posture;
}

}  // namespace kinetome::choreography
