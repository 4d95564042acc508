#include "kinetome/stages/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "kinetome/base/csv.h"
#include "kinetome/base/error.h"
#include "kinetome/formats/resample.h"
#include "kinetome/stages/bundle_file.h"
#include "kinetome/stages/motion_string_file.h"
#include "kinetome/stages/pose_hierarchy_file.h"
#include "kinetome/stages/segment_file.h"
#include "kinetome/stages/signature_query.h"
#include "kinetome/stages/stored_graph.h"
#include "kinetome/store/json_text.h"
#include "kinetome/store/neighbor_store.h"

namespace kinetome {
namespace {

std::string number_text(const Table::Cell& cell) {
    if (const auto* whole = std::get_if<int64_t>(&cell)) return fmt::format("{}", *whole);
    return fmt::format("{}", std::get<double>(cell));
}

std::string csv_rows(const Table& table) {
    std::string text;
    for (const auto& row : table.rows) {
        std::vector<std::string> cells;
        for (const Table::Cell& cell : row) {
            const auto* words = std::get_if<std::string>(&cell);
            cells.push_back(words ? csv_text(*words) : number_text(cell));
        }
        append_csv_line(text, cells);
    }
    return text;
}

/// Those of an array, without its brackets.
std::string json_rows(const Table& table) {
    Json rows = Json::array();
    for (const auto& row : table.rows) {
        Json object = Json::object();
        for (size_t i = 0; i < row.size(); ++i) {
            std::visit([&](const auto& value) { object[table.columns[i]] = value; }, row[i]);
        }
        rows.push_back(std::move(object));
    }
    // Bytes that are no UTF-8 have no JSON: a reader gets U+FFFD.
    const std::string array = rows.dump(1, ' ', false, Json::error_handler_t::replace);
    return array.substr(1, array.size() - 2);
}

/// Letters of one partition; frames at the pose rate become frames of the source: a source frame
/// has the letter of the analysis frame it falls on or follows.
void append_letters(const ArtifactReader& file, const std::string& partition, Table& table) {
    struct ClipRow {
        std::string name;
        int64_t frames, source_frames;
        double rate;
    };
    std::map<int64_t, ClipRow> clips;
    const auto ids = file.read<int64_t>(partition + "/clips/id");
    const auto names = file.read_texts(partition + "/clips/name");
    const auto frames = file.read<int64_t>(partition + "/clips/frames");
    const auto source_frames = file.read<int64_t>(partition + "/clips/source_frames");
    const auto rates = file.read<double>(partition + "/clips/source_rate");
    for (size_t i = 0; i < ids.size(); ++i) {
        clips[ids[i]] = {names[i], frames[i], source_frames[i], rates[i]};
    }
    const double pose_rate = file.read<double>(partition + "/pose_rate").at(0);
    const auto letters = file.read<int32_t>(partition + "/letters/letter");
    const auto clip_of = file.read<int64_t>(partition + "/letters/clip");
    const auto first = file.read<int32_t>(partition + "/letters/first_frame");
    const auto end = file.read<int32_t>(partition + "/letters/end_frame");
    for (size_t j = 0; j < letters.size(); ++j) {
        const ClipRow& clip = clips.at(clip_of[j]);
        const auto in_source = [&](int64_t frame) {
            if (frame == clip.frames) return clip.source_frames;
            return static_cast<int64_t>(std::ceil(source_frame(frame, clip.rate, pose_rate)));
        };
        const int64_t source_first = in_source(first[j]), source_end = in_source(end[j]);
        if (source_first == source_end) continue;  // a letter shorter than a frame of the source
        table.rows.push_back({clip.name, source_first, source_end, int64_t{letters[j]}});
    }
}

/// The graph of one clip.
void append_neighbors(const NeighborShardReader& shard, size_t number, Table& table) {
    const NeighborClip& clip = shard.clips()[number].clip;
    const double rate = shard.effector_rate(clip.clip_class);
    const auto in_source = [&](int64_t frame) {
        return static_cast<int64_t>(std::ceil(source_frame(frame, clip.source_rate, rate)));
    };
    const StoredNeighbors graph = shard.read(number);
    for (size_t frame = 0; frame + 1 < graph.offsets.size(); ++frame) {
        for (auto e = static_cast<size_t>(graph.offsets[frame]);
             e < static_cast<size_t>(graph.offsets[frame + 1]); ++e) {
            table.rows.push_back({clip.name, in_source(static_cast<int64_t>(frame)),
                                  in_source(graph.neighbours[e]),
                                  static_cast<double>(graph.distances[e])});
        }
    }
}

}  // namespace

TableFormat parse_table_format(std::string_view name) {
    if (name == "csv") return TableFormat::csv;
    if (name == "json") return TableFormat::json;
    throw UsageError(fmt::format("--format {}: expected csv or json", name));
}

TableWriter::TableWriter(const Table& header, TableFormat format, const TakeText& take)
    : format_(format), take_(take) {
    std::string text;
    if (format_ == TableFormat::csv) append_csv_line(text, header.columns);
    take_(format_ == TableFormat::csv ? text : "[");
}

void TableWriter::append(const Table& table) {
    if (table.rows.empty()) return;
    if (format_ == TableFormat::csv) return take_(csv_rows(table));
    std::string rows = json_rows(table);
    rows.pop_back();  // the end of the line, before the bracket
    if (!std::exchange(empty_, false)) take_(",");
    take_(rows);
}

void TableWriter::close() {
    if (format_ == TableFormat::json) take_(empty_ ? "]\n" : "\n]\n");
}

std::string write_table(const Table& table, TableFormat format) {
    std::string text;
    const TakeText take = [&](std::string_view piece) { text += piece; };
    TableWriter out(table, format, take);
    out.append(table);
    out.close();
    return text;
}

Table clip_table(const Generation& generation) {
    Table table{{"clip", "source", "class", "rate", "frames", "state", "reason"}, {}};
    for (const CatalogClip& clip : generation.catalog().clips) {
        std::string state = clip.indexed() ? "indexed" : "quarantined", reason = clip.quarantined;
        if (clip.indexed() && !clip.skipped.empty()) {
            state = "skipped by " + clip.skipped.begin()->first;
            reason = clip.skipped.begin()->second;
        }
        table.rows.push_back(
            {clip.name, clip.source, clip.clip_class, clip.rate, clip.frames, state, reason});
    }
    return table;
}

Table letter_table(const Generation& generation) {
    Table table{{"clip", "first", "end", "letter"}, {}};
    const ArtifactReader file = generation.open("motion_strings.h5");
    for (const std::string& partition : spelled_partitions(file))
        append_letters(file, partition, table);
    std::stable_sort(table.rows.begin(), table.rows.end(), [](const auto& a, const auto& b) {
        return std::get<std::string>(a[0]) < std::get<std::string>(b[0]);
    });
    return table;
}

Table bundle_table(const Generation& generation) {
    Table table{{"bundle", "clip", "first", "end", "degenerate"}, {}};
    const StoredBundles bundles = read_bundles(generation.open("bundles.h5"));
    const std::vector<int32_t> heights = bundles.heights();
    for (const BundleMember& member : bundles.members) {
        const CutClip& clip = bundles.clips[static_cast<size_t>(member.frames.clip)];
        table.rows.push_back({int64_t{member.bundle}, clip.name,
                              source_boundary(clip, member.frames.first, bundles.pose_rate),
                              source_boundary(clip, member.frames.end, bundles.pose_rate),
                              int64_t{heights[static_cast<size_t>(member.bundle)] == 1}});
    }
    return table;
}

Table segment_table(const Generation& generation) {
    Table table{{"clip", "first", "end", "kind", "activity_cluster"}, {}};
    const ArtifactReader file = generation.open("segments.h5");
    for (const SegmentedClip& clip : in_source(read_segments(file), effector_rate_of(file))) {
        for (const Segment& segment : clip.segments) {
            table.rows.push_back({clip.clip.name, segment.frames.first, segment.frames.end,
                                  segment.kind == SegmentKind::activity ? "activity" : "transition",
                                  int64_t{segment.cluster}});
        }
    }
    return table;
}

Table primitive_table(const OpenStore& open, const std::filesystem::path& labels) {
    const Generation& generation = open.generation;
    const std::vector<ClipPrimitive> labelled = stored_primitives(open, labels);
    auto next = labelled.begin();
    Table table{{"clip", "first", "end", "activity_first", "cluster", "label"}, {}};
    const ArtifactReader file = generation.open("primitives.h5");
    const double rate = effector_rate_of(file);
    const std::vector<SegmentedClip> segmented = read_segments(generation.open("segments.h5"));
    auto activities = segmented.begin();
    for (const PrimitiveClip& clip : read_primitives(file)) {
        while (activities->clip.name != clip.clip.name) ++activities;
        for (const StoredPrimitive& stored : clip.primitives) {
            const ClipPrimitive& primitive = *next++;
            if (primitive.first == primitive.end) continue;  // as in_source leaves it out
            const Segment& activity =
                activities->segments.at(static_cast<size_t>(stored.primitive.activity));
            table.rows.push_back({clip.clip.name, primitive.first, primitive.end,
                                  source_boundary(clip.clip, activity.frames.first, rate),
                                  int64_t{stored.cluster}, primitive.label});
        }
    }
    return table;
}

void write_neighbors(const Generation& generation, TableFormat format, const TakeText& take) {
    const auto shards = generation.made_by("neighbors");
    const Table header{{"clip", "frame", "neighbour", "distance"}, {}};
    TableWriter out(header, format, take);
    for (const Receipt* const receipt : shards) {
        const NeighborShardReader shard(generation.open(receipt->file.file_name));
        std::map<std::string, size_t> in_name_order;
        for (size_t i = 0; i < shard.clips().size(); ++i) {
            in_name_order[shard.clips()[i].clip.name] = i;
        }
        for (const auto& [name, number] : in_name_order) {
            Table rows = header;
            append_neighbors(shard, number, rows);
            out.append(rows);
        }
    }
    out.close();
}

Table hierarchy_table(const Generation& generation) {
    Table table{{"class", "node", "parent", "below", "above", "leaf", "frames", "error_mm"}, {}};
    const ArtifactReader file = generation.open("pose_hierarchy.h5");
    for (const std::string& clip_class : hierarchy_classes(file)) {
        const PoseHierarchy hierarchy = read_pose_hierarchy(file, "/" + clip_class).hierarchy;
        for (size_t i = 0; i < hierarchy.nodes.size(); ++i) {
            const HierarchyNode& node = hierarchy.nodes[i];
            Table::Cell error = std::string();
            if (node.is_leaf()) error = hierarchy.leaf_errors[node.leaf];
            table.rows.push_back({clip_class, static_cast<int64_t>(i), int64_t{node.parent},
                                  int64_t{node.below}, int64_t{node.above}, int64_t{node.leaf},
                                  node.rows, error});
        }
    }
    return table;
}

Table export_table(const OpenStore& open, std::string_view what,
                   const std::filesystem::path& labels) {
    const Generation& generation = open.generation;
    if (what == "clips") return clip_table(generation);
    if (what == "letters") return letter_table(generation);
    if (what == "bundles") return bundle_table(generation);
    if (what == "segments") return segment_table(generation);
    if (what == "primitives") return primitive_table(open, labels);
    if (what == "hierarchy") return hierarchy_table(generation);
    if (what == "signatures") return signature_table(generation);
    throw UsageError(
        fmt::format("cannot export '{}': there are clips, letters, bundles, bundle-graph, "
                    "hierarchy, neighbors, segments, primitives, "
                    "primitive-graph, signatures, timeline",
                    what));
}

}  // namespace kinetome
