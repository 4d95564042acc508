// The activities of the procedural corpus: what the body does at each moment of a cycle.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "kinetome/synthesis/posture.h"
#include "kinetome/synthesis/value_table.h"

namespace kinetome {

enum class Activity : uint8_t {
    walk,
    run,
    jump,
    punch_left,
    punch_right,
    kick_left,
    kick_right,
    squat,
    arm_circles,
    wave,
    sit,
    idle,
    count
};

/// The label in truth.csv and cycles.csv.
std::string_view activity_name(Activity activity);

/// Whether it repeats; an activity that does not has no rows in cycles.csv.
bool is_cyclic(Activity activity);

/// How a performer differs from the norm, in one cycle. Factors are 1 and offsets 0 in the norm.
enum class Trait : uint8_t {
    tempo,       ///< factor of the rate
    size,        ///< factor of the main movement's extent
    arm_size,    ///< factor of what the arms add
    trunk_size,  ///< factor of what trunk and pelvis add
    bounce,      ///< factor of the vertical movement
    stance,      ///< factor of the distance between the feet
    lean,        ///< offset, radians forward
    elbow,       ///< offset, radians
    curl,        ///< share in [0, 1] of a second form: a hook, a tuck, a small circle
    arm_lag,     ///< offset, cycles, of the arms behind the legs
    trunk_lag,   ///< offset, cycles, of the trunk behind the legs
    skew,        ///< offset: left larger than right by this share
    turn,        ///< offset, radians a second
    count
};
using Traits = ValueTable<Trait>;

/// The norm.
Traits usual_traits();

/// Where in its cycles a performer is.
struct Moment {
    double phase = 0;  ///< cycles since the activity began
    double rate = 1;   ///< cycles a second, now
};

/// Usual seconds of a cycle, before the tempo.
double usual_cycle_seconds(Activity activity);

Posture activity_posture(Activity activity, const Traits& traits, const Moment& moment);

}  // namespace kinetome
