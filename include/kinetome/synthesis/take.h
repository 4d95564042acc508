// The motion of a planned take.
#pragma once

#include <cstdint>
#include <memory>

#include "kinetome/formats/clip.h"
#include "kinetome/synthesis/body.h"
#include "kinetome/synthesis/take_plan.h"

namespace kinetome {

/// A performer: the body and its skeleton.
struct Subject {
    Body body;
    std::shared_ptr<const Skeleton> skeleton;
};
Subject make_subject(int64_t subject, uint64_t seed);

/// Plays the plan: postures of the activities, blended, with the performer's wandering and the
/// noise of a capture system on top. The same for the same arguments.
Clip perform(const TakePlan& plan, const Subject& subject, uint64_t seed);

}  // namespace kinetome
