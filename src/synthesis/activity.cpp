#include "kinetome/synthesis/activity.h"

#include <stdexcept>

#include "choreography.h"

namespace kinetome {

std::string_view activity_name(Activity activity) {
    constexpr std::array<std::string_view, static_cast<size_t>(Activity::count)> names = {
        "walk",       "run",   "jump",        "punch_left", "punch_right", "kick_left",
        "kick_right", "squat", "arm_circles", "wave",       "sit",         "idle"};
    return names.at(static_cast<size_t>(activity));
}

bool is_cyclic(Activity activity) {
    return activity != Activity::idle;
}

Traits usual_traits() {
    Traits traits;
    using enum Trait;
    for (const Trait factor : {tempo, size, arm_size, trunk_size, bounce, stance})
        traits[factor] = 1;
    return traits;
}

double usual_cycle_seconds(Activity activity) {
    constexpr std::array<double, static_cast<size_t>(Activity::count)> seconds = {
        1.15, 0.78, 1.75, 1.25, 1.30, 1.65, 1.65, 2.70, 1.45, 0.95, 6.50, 6.00};
    return seconds.at(static_cast<size_t>(activity));
}

Posture activity_posture(Activity activity, const Traits& traits, const Moment& moment) {
    using namespace choreography;
    switch (activity) {
        case Activity::walk:
            return walk(traits, moment);
        case Activity::run:
            return run(traits, moment);
        case Activity::jump:
            return jump(traits, moment);
        case Activity::punch_left:
            return punch(Side::left, traits, moment);
        case Activity::punch_right:
            return punch(Side::right, traits, moment);
        case Activity::kick_left:
            return kick(Side::left, traits, moment);
        case Activity::kick_right:
            return kick(Side::right, traits, moment);
        case Activity::squat:
            return squat(traits, moment);
        case Activity::arm_circles:
            return arm_circles(traits, moment);
        case Activity::wave:
            return wave(traits, moment);
        case Activity::sit:
            return sit(traits, moment);
        case Activity::idle:
            return idle(traits, moment);
        case Activity::count:
            break;
    }
    throw std::invalid_argument("no such activity");
}

}  // namespace kinetome
