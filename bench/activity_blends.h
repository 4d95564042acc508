// Frames that are of two activities: where truth leaves open when one ends and the next begins.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "kinetome/formats/annotation.h"
#include "kinetome/models/bundle_score.h"

namespace kinetome::bench {

/// By frame the class that it may be of beside its own, or none. `rows` are of one take.
inline FrameClasses blended_with(std::span<const TruthRow> rows, int64_t frames,
                                 const std::map<std::string, int32_t>& numbers) {
    FrameClasses classes(static_cast<size_t>(frames), no_class);
    const auto fill = [&](int64_t first, int64_t end, int32_t number) {
        for (int64_t frame = std::max<int64_t>(first, 0); frame < std::min(end, frames); ++frame)
            classes[static_cast<size_t>(frame)] = number;
    };
    for (const TruthRow& row : rows) {
        const auto next = std::ranges::find(rows, row.end, &TruthRow::first);
        if (next == rows.end() || next->label == row.label) continue;
        fill(std::max(row.end_lo, row.first), row.end, numbers.at(next->label));
        fill(row.end, std::min(row.end_hi, next->end), numbers.at(row.label));
    }
    return classes;
}

}  // namespace kinetome::bench
