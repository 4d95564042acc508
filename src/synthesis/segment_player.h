// Plays one segment of a plan at any time.
#pragma once

#include "kinetome/synthesis/take_plan.h"

namespace kinetome {

/// Times must not decrease from call to call.
class SegmentPlayer {
  public:
    explicit SegmentPlayer(const SegmentPlan& segment) : segment_(&segment) {}

    /// The posture at a time in frames of the take, from blend to blend.
    Posture posture_at(double frame);

  private:
    /// Cycles a frame at the start of cycle i: that of both neighbours, so that it does not jump.
    double rate_at_start(size_t i) const;

    const SegmentPlan* segment_;
    size_t cycle_ = 0;
};

/// A blend in which the feet step one after the other instead of gliding.
Posture mix_with_steps(const Posture& from, const Posture& to, double at);

}  // namespace kinetome
