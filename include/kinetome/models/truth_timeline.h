// What people say happens in a take, made fit to be compared with.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinetome/base/pieces.h"
#include "kinetome/formats/annotation.h"

namespace kinetome {

struct TrueActivity {
    RowRange frames;
    int32_t label = 0;  ///< of TruthTimeline::classes
    bool operator==(const TrueActivity&) const = default;
};

/// Frames count at the rate of the annotation. Activities follow each other from frame 0 to the
/// end of the take; zone i is where the boundary after activity i may lie, [lo, hi) around it.
struct TruthTimeline {
    std::vector<std::string> classes;  ///< in the order in which they first occur
    std::vector<TrueActivity> activities;
    std::vector<RowRange> zones;  ///< one fewer than activities; in order, both first and end

    int64_t frames() const { return activities.empty() ? 0 : activities.back().frames.end; }
    std::vector<int32_t> class_of_frames() const;  ///< one a frame
    std::vector<char> uncertain_frames() const;    ///< one a frame: whether some zone holds it
};

/// The rows of one clip, in the order of its frames, for a take of `frames` frames at `rate` frames
/// a second. The last activity goes on to the end of the take.
///
/// Slips of the pen in a zone are mended: it always holds its boundary; a side that reaches over a
/// neighbouring boundary has no frames; a side that is wider than three times the other and 2.5 s
/// is made as wide as the other.
///
/// Throws InputError naming `path` and the row's line: for rows that overlap or leave frames
/// without a label, an activity without frames, and frames beyond the end of the take.
TruthTimeline truth_timeline(std::span<const TruthRow> rows, int64_t frames, double rate,
                             const std::string& path);

}  // namespace kinetome
