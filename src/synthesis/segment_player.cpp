#include "segment_player.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinetome/synthesis/curve.h"

namespace kinetome {

double SegmentPlayer::rate_at_start(size_t i) const {
    const auto& cycles = segment_->cycles;
    const double own = cycles[std::min(i, cycles.size() - 1)].frames;
    return 2 / (own + cycles[i > 0 ? i - 1 : 0].frames);
}

Posture SegmentPlayer::posture_at(double frame) {
    const auto& cycles = segment_->cycles;
    while (cycle_ + 1 < cycles.size() && frame >= cycles[cycle_ + 1].first) ++cycle_;
    const CyclePlan& cycle = cycles[cycle_];
    const double from = rate_at_start(cycle_), to = rate_at_start(cycle_ + 1);
    const double at = (frame - cycle.first) / cycle.frames;
    const auto number = static_cast<double>(cycle_);

    Moment moment;
    if (at < 0) {
        moment = {number + from * (frame - cycle.first), from * synthesis_rate};
    } else {
        const double slope_from = from * cycle.frames, slope_to = to * cycle.frames;
        const double within = hermite(at, 0, 1, slope_from, slope_to);
        const double speed =
            6 * at * (1 - at) + slope_from * (1 - at) * (1 - 3 * at) + slope_to * at * (3 * at - 2);
        moment = {number + within, speed / cycle.frames * synthesis_rate};
    }
    const Traits& next = cycles[std::min(cycle_ + 1, cycles.size() - 1)].traits;
    const Traits traits = mix(cycle.traits, next, smooth_step(at));
    const Posture posture = activity_posture(segment_->activity, traits, moment);
    Posture shown = segment_->mirrored ? mirrored(posture) : posture;
    shown += segment_->carriage;
    return shown;
}

Posture mix_with_steps(const Posture& from, const Posture& to, double at) {
    Posture mixed = mix(from, to, smooth_step(at));
    constexpr double step = 0.62;  // of the blend; the second foot ends with it
    for (const Side side : both_sides) {
        const double start = side == Side::left ? 0 : 1 - step;
        const double own = smooth_step((at - start) / step);
        const ValueTable<Leg>& old_leg = from.leg(side);
        const ValueTable<Leg>& new_leg = to.leg(side);
        ValueTable<Leg>& leg = mixed.leg(side);
        leg = mix(old_leg, new_leg, own);
        const double distance = std::hypot(new_leg[Leg::ahead] - old_leg[Leg::ahead],
                                           new_leg[Leg::out] - old_leg[Leg::out]);
        const double hop = std::sin(std::numbers::pi * own);
        leg[Leg::lift] += std::min(0.08, 0.3 * distance) * hop * hop;
    }
    return mixed;
}

}  // namespace kinetome
