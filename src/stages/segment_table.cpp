#include "kinetome/stages/segment_table.h"

#include <algorithm>
#include <limits>
#include <map>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"
#include "kinetome/formats/csv_table.h"

namespace kinetome {
namespace {

struct SegmentLine {
    Segment segment;
    int64_t line = 0;
};

struct PrimitiveLine {
    RowRange frames;
    int32_t cluster = 0;
    int64_t line = 0;
};

RowRange frames_of(const CsvRecord& record, const std::string& path) {
    const RowRange frames = {whole_number_field(record, 1, "a frame number", path),
                             whole_number_field(record, 2, "a frame number", path)};
    if (frames.end <= frames.first) {
        throw InputError::at_line(path, record.line,
                                  "expected an end behind the first frame " +
                                      std::to_string(frames.first) + ", found " +
                                      std::to_string(frames.end));
    }
    return frames;
}

int32_t cluster_field(const CsvRecord& record, size_t field, const std::string& path) {
    const int64_t cluster = whole_number_field(record, field, "the number of a cluster", path);
    if (cluster > std::numeric_limits<int32_t>::max()) {
        throw InputError::at_line(path, record.line, "the number of the cluster is too large");
    }
    return static_cast<int32_t>(cluster);
}

Segment segment_of(const CsvRecord& record, const std::string& path) {
    const std::string &kind = record.fields[3], &cluster = record.fields[4];
    const RowRange frames = frames_of(record, path);
    if (kind == "activity") {
        return {frames, SegmentKind::activity, cluster_field(record, 4, path)};
    }
    if (kind != "transition") {
        throw InputError::at_line(
            path, record.line, "expected activity or transition, found " + quote_for_message(kind));
    }
    if (!cluster.empty() && cluster != "-1") {
        throw InputError::at_line(path, record.line,
                                  "a transition has no cluster: expected -1 or nothing, found " +
                                      quote_for_message(cluster));
    }
    return {frames, SegmentKind::transition, -1};
}

std::string in_clip(const std::string& clip) {
    return "clip " + quote_for_message(clip);
}

/// Where a segment or primitive begins before the one before it ends.
[[noreturn]] void refuse_overlap(const std::string& path, int64_t line, const std::string& clip,
                                 int64_t first, int64_t end_before) {
    throw InputError::at_line(path, line,
                              in_clip(clip) + " is cut at frame " + std::to_string(first) +
                                  ", inside what lasts until " + std::to_string(end_before));
}

std::vector<Segment> without_gaps(const std::vector<SegmentLine>& lines, const std::string& clip,
                                  const std::string& path) {
    std::vector<Segment> segments;
    int64_t end = 0;
    for (const auto& [segment, line] : lines) {
        const int64_t first = segment.frames.first;
        if (first < end) refuse_overlap(path, line, clip, first, end);
        if (first > end) {
            throw InputError::at_line(path, line,
                                      in_clip(clip) + " has no segment from frame " +
                                          std::to_string(end) + " to " + std::to_string(first) +
                                          ": call it a transition if it is none of the others");
        }
        segments.push_back(segment);
        end = segment.frames.end;
    }
    return segments;
}

}  // namespace

std::vector<SegmentedTake> parse_segments_csv(std::string_view text, const std::string& path,
                                              double rate) {
    std::map<std::string, std::vector<SegmentLine>> clips;
    for (const CsvRecord& record :
         parse_csv_table(text, path, {"clip", "first", "end", "kind", "activity_cluster"})) {
        clips[from_csv_text(record.fields[0])].push_back({segment_of(record, path), record.line});
    }
    std::vector<SegmentedTake> takes;
    for (auto& [clip, lines] : clips) {
        std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) {
            return a.segment.frames.first < b.segment.frames.first;
        });
        takes.push_back(
            {clip, lines.back().segment.frames.end, rate, without_gaps(lines, clip, path)});
    }
    return takes;
}

std::vector<PrimitivesOfTake> parse_primitives_csv(std::string_view text, const std::string& path) {
    std::map<std::string, std::vector<PrimitiveLine>> clips;
    for (const CsvRecord& record : parse_csv_table(
             text, path, {"clip", "first", "end", "activity_first", "cluster", "label"})) {
        clips[from_csv_text(record.fields[0])].push_back(
            {frames_of(record, path), cluster_field(record, 4, path), record.line});
    }
    std::vector<PrimitivesOfTake> takes;
    for (auto& [clip, lines] : clips) {
        std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) {
            return a.frames.first < b.frames.first;
        });
        PrimitivesOfTake take{clip, {}, {}};
        for (const auto& [frames, cluster, line] : lines) {
            const int64_t end = take.primitives.empty() ? 0 : take.primitives.back().end;
            if (frames.first < end) refuse_overlap(path, line, clip, frames.first, end);
            take.primitives.push_back(frames);
            take.clusters.push_back(cluster);
        }
        takes.push_back(std::move(take));
    }
    return takes;
}

}  // namespace kinetome
