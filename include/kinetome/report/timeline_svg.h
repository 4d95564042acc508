// A take's annotation and segments drawn above each other along its time (S3 Fig. 4).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinetome/base/pieces.h"
#include "kinetome/models/segment.h"
#include "kinetome/models/truth_timeline.h"

namespace kinetome {

/// A stretch of a row. Bars of one colour number are of one colour, in all rows; without a number
/// a bar is grey.
struct TimelineBar {
    RowRange frames;
    std::optional<int32_t> colour;
    std::string name;  ///< written into the bar where it has room, and shown when pointed at
};

struct TimelineRow {
    std::string name;
    std::vector<TimelineBar> bars;
    std::vector<RowRange> uncertain = {};  ///< hatched
    std::vector<int64_t> ticks = {};       ///< frames at which a primitive begins
};

struct Timeline {
    std::string title;
    int64_t frames = 0;
    double rate = 120;  ///< frames a second
    std::vector<TimelineRow> rows;
    std::vector<std::string> colour_names = {};  ///< of the first colour numbers, told below
};

/// Activities in the colours of their classes, zones hatched.
TimelineRow truth_row(const TruthTimeline& truth);

/// Activities in the colours of their clusters, transitions grey, a tick where a primitive begins
/// inside an activity. A cluster has the colour and name of the class that most agrees with it, no
/// two clusters those of one class; other clusters have colours and numbers of their own.
/// `segments` and `primitives` count frames as `truth` does.
TimelineRow segment_row(const std::string& name, std::span<const Segment> segments,
                        std::span<const RowRange> primitives, const TruthTimeline& truth);

/// Where there is no annotation: clusters have their own numbers and colours.
TimelineRow segment_row(const std::string& name, std::span<const Segment> segments,
                        std::span<const RowRange> primitives);

/// One self-contained picture, the same text for the same timeline. Colours are told apart without
/// colour vision, and never carry a meaning alone.
std::string timeline_svg(const Timeline& timeline);

}  // namespace kinetome
