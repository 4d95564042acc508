#include "kinetome/synthesis/style.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "posture_spread.h"

namespace kinetome {
namespace {

constexpr double degree = std::numbers::pi / 180;

constexpr bool is_factor(Trait trait) {
    return trait <= Trait::stance;
}

/// How far two people differ, one standard deviation: of the logarithm for factors.
Traits trait_spread() {
    Traits spread;
    using enum Trait;
    spread[tempo] = 0.10;
    spread[size] = 0.09;
    spread[arm_size] = 0.22;
    spread[trunk_size] = 0.25;
    spread[bounce] = 0.22;
    spread[stance] = 0.10;
    spread[lean] = 3.5 * degree;
    spread[elbow] = 8 * degree;
    spread[arm_lag] = 0.025;
    spread[trunk_lag] = 0.03;
    spread[skew] = 0.06;
    return spread;
}

Traits random_traits(double spread, RandomStream& random) {
    const Traits unit = trait_spread();
    Traits traits;
    for (size_t i = 0; i < Traits::size; ++i) {
        const auto trait = static_cast<Trait>(i);
        const double drawn = spread * unit[trait] * std::clamp(random.normal(), -2.5, 2.5);
        traits[trait] = is_factor(trait) ? std::exp(drawn) : drawn;
    }
    return traits;
}

template <class Key>
void draw(ValueTable<Key>& table, const ValueTable<Key>& unit, double spread,
          RandomStream& random) {
    for (size_t i = 0; i < ValueTable<Key>::size; ++i) {
        const auto key = static_cast<Key>(i);
        table[key] = spread * unit[key] * std::clamp(random.normal(), -2.5, 2.5);
    }
}

}  // namespace

Posture posture_spread() {
    Posture spread;
    using enum Trunk;
    spread[pelvis_advance] = 0.006;
    spread[pelvis_shift] = 0.006;
    spread[pelvis_pitch] = 2.2 * degree;
    spread[pelvis_yaw] = 2.0 * degree;
    spread[pelvis_roll] = 1.0 * degree;
    spread[spine_flexion] = 3.0 * degree;
    spread[spine_twist] = 2.5 * degree;
    spread[spine_lean] = 2.0 * degree;
    spread[neck_flexion] = 5.0 * degree;
    spread[neck_twist] = 5.0 * degree;
    spread[neck_lean] = 3.0 * degree;
    for (const Side side : both_sides) {
        ValueTable<Arm>& arm = spread.arm(side);
        arm[Arm::flexion] = 3.5 * degree;
        arm[Arm::abduction] = 3.5 * degree;
        arm[Arm::inward] = 6.0 * degree;
        arm[Arm::elbow] = 4.0 * degree;
        arm[Arm::pronation] = 11.0 * degree;
        arm[Arm::wrist_flexion] = 8.0 * degree;
        arm[Arm::wrist_deviation] = 6.0 * degree;
        arm[Arm::finger_flexion] = 7.0 * degree;
        arm[Arm::thumb_flexion] = 6.0 * degree;
        arm[Arm::thumb_spread] = 6.0 * degree;
        arm[Arm::shrug] = 2.5 * degree;
        arm[Arm::protraction] = 2.5 * degree;
        ValueTable<Leg>& leg = spread.leg(side);
        leg[Leg::toe_out] = 3.5 * degree;
        leg[Leg::knee_out] = 2.5 * degree;
        leg[Leg::toe_bend] = 3.0 * degree;
    }
    return spread;
}

Traits combine(const Traits& base, const Traits& change) {
    Traits combined;
    for (size_t i = 0; i < Traits::size; ++i) {
        const auto trait = static_cast<Trait>(i);
        combined[trait] =
            is_factor(trait) ? base[trait] * change[trait] : base[trait] + change[trait];
    }
    // What many people's departures multiplied could reach, a body could not.
    using enum Trait;
    combined[tempo] = std::clamp(combined[tempo], 0.7, 1.4);
    combined[size] = std::clamp(combined[size], 0.75, 1.2);
    for (const Trait factor : {arm_size, trunk_size, bounce})
        combined[factor] = std::clamp(combined[factor], 0.4, 1.7);
    combined[stance] = std::clamp(combined[stance], 0.75, 1.3);
    combined[elbow] = std::clamp(combined[elbow], -14 * degree, 25 * degree);
    combined[lean] = std::clamp(combined[lean], -8 * degree, 10 * degree);
    return combined;
}

Style& Style::operator+=(const Style& other) {
    traits = combine(traits, other.traits);
    carriage += other.carriage;
    return *this;
}

Style random_style(double spread, RandomStream& random) {
    Style style;
    style.traits = random_traits(spread, random);
    const Posture unit = posture_spread();
    draw(style.carriage.trunk, unit.trunk, spread, random);
    for (const Side side : both_sides) {
        draw(style.carriage.arm(side), unit.arm(side), spread, random);
        draw(style.carriage.leg(side), unit.leg(side), spread, random);
    }
    return style;
}

Traits random_cycle_traits(double spread, RandomStream& random) {
    return random_traits(spread, random);
}

void choose_form(Activity activity, Traits& traits, RandomStream& random) {
    const double kind = random.uniform();
    const double amount = random.uniform();
    const double signed_amount = 2 * random.uniform() - 1;
    using enum Trait;
    switch (activity) {
        case Activity::walk:
        case Activity::run:
            traits[turn] = (kind < 0.4 ? 8 : 45) * degree * signed_amount;
            break;
        case Activity::jump:
            traits[curl] = kind < 0.5 ? 0 : amount;
            traits[turn] = kind < 0.75 ? 0 : 160 * degree * signed_amount;
            // Gravity sets the time in the air: a slow jump would be a high one.
            traits[tempo] = std::clamp(traits[tempo], 0.92, 1.2);
            break;
        case Activity::punch_left:
        case Activity::punch_right:
            traits[curl] = kind < 0.7 ? 0.08 * amount : 0.3 + 0.5 * amount;
            break;
        case Activity::arm_circles:
            traits[curl] = kind < 0.6 ? 0.15 * amount : 0.75 + 0.25 * amount;
            traits[skew] = signed_amount < 0.5 ? 0 : 0.3;
            break;
        case Activity::idle:
            traits[curl] = kind < 0.5 ? 0 : amount;
            break;
        default:
            traits[curl] = amount;
    }
}

}  // namespace kinetome
