// Annotations and segments as rows of a timeline.
#include <fmt/format.h>

#include <map>

#include "kinetome/models/segmentation_score.h"
#include "kinetome/report/timeline_svg.h"

namespace kinetome {
namespace {

struct Look {
    int32_t colour;
    std::string name;
};

using Looks = std::map<int32_t, Look>;  // of clusters

std::string number_name(int32_t cluster) {
    return fmt::format("#{}", cluster);
}

Looks looks_by_class(const TruthTimeline& truth, std::span<const Segment> segments) {
    Looks looks;
    auto free_colour = static_cast<int32_t>(truth.classes.size());
    for (const auto& [cluster, its_class] : classes_of_clusters(truth, segments)) {
        if (its_class >= 0) {
            looks[cluster] = {its_class, truth.classes[static_cast<size_t>(its_class)]};
        } else {
            looks[cluster] = {free_colour++, number_name(cluster)};
        }
    }
    return looks;
}

Looks looks_by_number(std::span<const Segment> segments) {
    Looks looks;
    for (const Segment& segment : segments) {
        if (segment.kind == SegmentKind::transition) continue;
        looks.try_emplace(segment.cluster, Look{segment.cluster, number_name(segment.cluster)});
    }
    return looks;
}

TimelineRow row_of(const std::string& name, std::span<const Segment> segments,
                   std::span<const RowRange> primitives, const Looks& looks) {
    TimelineRow row{name, {}, {}, {}};
    for (const Segment& segment : segments) {
        if (segment.kind == SegmentKind::transition) {
            row.bars.push_back({segment.frames, std::nullopt, "transition"});
            continue;
        }
        const Look& look = looks.at(segment.cluster);
        row.bars.push_back({segment.frames, look.colour, look.name});
        for (const RowRange& primitive : primitives) {
            if (segment.frames.first < primitive.first && primitive.first < segment.frames.end) {
                row.ticks.push_back(primitive.first);
            }
        }
    }
    return row;
}

}  // namespace

TimelineRow truth_row(const TruthTimeline& truth) {
    TimelineRow row{"annotation", {}, truth.zones, {}};
    for (const TrueActivity& activity : truth.activities) {
        row.bars.push_back(
            {activity.frames, activity.label, truth.classes[static_cast<size_t>(activity.label)]});
    }
    return row;
}

TimelineRow segment_row(const std::string& name, std::span<const Segment> segments,
                        std::span<const RowRange> primitives, const TruthTimeline& truth) {
    return row_of(name, segments, primitives, looks_by_class(truth, segments));
}

TimelineRow segment_row(const std::string& name, std::span<const Segment> segments,
                        std::span<const RowRange> primitives) {
    return row_of(name, segments, primitives, looks_by_number(segments));
}

}  // namespace kinetome
