// Frames that are of two activities: where truth leaves open when one ends and the next begins.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>

#include "kinetome/models/bundle_score.h"
#include "kinetome/models/truth_timeline.h"

namespace kinetome::bench {

/// By frame the class that it may be of beside its own, or none. Of a take of so many frames, which
/// may have no annotation.
inline FrameClasses blended_with(const TruthTimeline& truth, int64_t frames,
                                 const std::map<std::string, int32_t>& numbers) {
    FrameClasses classes(static_cast<size_t>(frames), no_class);
    const auto number = [&](const TrueActivity& activity) {
        return numbers.at(truth.classes[static_cast<size_t>(activity.label)]);
    };
    for (size_t i = 0; i < truth.zones.size(); ++i) {
        const TrueActivity &before = truth.activities[i], &after = truth.activities[i + 1];
        if (before.label == after.label) continue;
        const auto boundary = classes.begin() + after.frames.first;
        std::fill(classes.begin() + truth.zones[i].first, boundary, number(after));
        std::fill(boundary, classes.begin() + truth.zones[i].end, number(before));
    }
    return classes;
}

}  // namespace kinetome::bench
