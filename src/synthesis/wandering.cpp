#include "wandering.h"

#include <numbers>
#include <string_view>

#include "kinetome/synthesis/take_plan.h"
#include "posture_spread.h"

namespace kinetome {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double frame_seconds = 1 / synthesis_rate;
constexpr double wandering_share = 1.0;  // of the spread between people

/// Standard deviation of a joint's slow bending of its own: the trunk is a chain of many joints,
/// the legs must keep the feet where they are.
double slow_bending(std::string_view joint) {
    for (const std::string_view part :
         {"lowerback", "upperback", "thorax", "lclavicle", "rclavicle"})
        if (joint == part) return 1.6 * degree;
    for (const std::string_view part : {"lowerneck", "upperneck", "head"})
        if (joint == part) return 2.2 * degree;
    return 0.25 * degree;
}

/// Standard deviation of the capture's own noise: joints with few or close markers shake most.
double shaking(std::string_view joint) {
    for (const std::string_view part : {"wrist", "hand", "thumb", "toes", "fingers"})
        if (joint.ends_with(part)) return 0.5 * degree;
    return 0.18 * degree;
}

}  // namespace

PostureWandering::PostureWandering(RandomStream& random) {
    const Posture spread = posture_spread();
    add_tracks(step_.trunk, spread.trunk, random);
    for (const Side side : both_sides) {
        add_tracks(step_.arm(side), spread.arm(side), random);
        add_tracks(step_.leg(side), spread.leg(side), random);
    }
}

template <class Key>
void PostureWandering::add_tracks(ValueTable<Key>& step, const ValueTable<Key>& spread,
                                  RandomStream& random) {
    for (size_t i = 0; i < ValueTable<Key>::size; ++i) {
        const auto key = static_cast<Key>(i);
        if (spread[key] == 0) continue;
        const double knot_seconds = random.uniform(0.5, 1.5);
        tracks_.push_back({&step[key], Drift(wandering_share * spread[key], knot_seconds, random)});
    }
}

void PostureWandering::add_to(Posture& posture, RandomStream& random) {
    for (Track& track : tracks_) *track.value = track.drift.next(frame_seconds, random);
    posture += step_;
}

JointNoise::JointNoise(const Skeleton& skeleton, RandomStream& random) {
    for (const Joint& joint : skeleton.joints()) {
        for (const Channel channel : joint.channels) {
            const bool turns = is_rotation(channel);
            const bool root = joint.parent < 0;
            const double slow = !turns || root ? 0 : slow_bending(joint.name);
            const double fast = turns ? shaking(joint.name) : 0.05;  // radians or cm
            const double white = 0.15 * fast;
            tracks_.push_back({Drift(slow, random.uniform(0.4, 1.2), random),
                               Drift(fast, random.uniform(0.05, 0.12), random), white});
        }
    }
}

void JointNoise::add_to(std::span<double> dofs, RandomStream& random) {
    for (size_t i = 0; i < tracks_.size(); ++i) {
        Track& track = tracks_[i];
        dofs[i] += track.slow.next(frame_seconds, random) + track.fast.next(frame_seconds, random) +
                   track.white * quick_normal(random);
    }
}

}  // namespace kinetome
