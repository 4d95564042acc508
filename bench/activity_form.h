// Which of the forms of its activity a generated segment has: they share a label, and are different
// motions.
#pragma once

#include <string>
#include <string_view>

#include "kinetome/synthesis/take_plan.h"

namespace kinetome::bench {

/// Empty for activities of one form, such as walking; the limits are those of choose_form.
inline std::string_view form_of(const SegmentPlan& segment) {
    const Traits& traits = segment.cycles.front().traits;
    const double second_form = traits[Trait::curl];
    switch (segment.activity) {
        case Activity::punch_left:
        case Activity::punch_right:
            return second_form >= 0.3 ? "hook" : "straight";
        case Activity::arm_circles:
            return second_form >= 0.5 ? "small" : "large";
        case Activity::wave:
            return segment.mirrored ? "left hand" : "right hand";
        case Activity::idle:
            return second_form >= 0.5 ? "arms folded" : "arms down";
        default:
            return {};
    }
}

/// Label and form.
inline std::string motion_of(const SegmentPlan& segment) {
    std::string motion(activity_name(segment.label()));
    if (const auto form = form_of(segment); !form.empty()) motion.append(", ").append(form);
    return motion;
}

}  // namespace kinetome::bench
