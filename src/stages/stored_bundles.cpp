#include "kinetome/stages/stored_bundles.h"

#include <algorithm>
#include <map>
#include <set>

#include "kinetome/base/error.h"
#include "kinetome/models/bundle_members.h"
#include "kinetome/stages/bundle_file.h"

namespace kinetome {
namespace {

/// Members of nodes, at the sources' rates.
std::vector<ClipPrimitive> node_members(const Generation& generation) {
    const StoredBundles bundles = read_bundles(generation.open("bundles.h5"));
    const auto node_of = read_bundle_graph(generation.open("bundle_graph.h5"), bundles).node_of;
    std::vector<ClipPrimitive> members;
    for (const BundleMember& member : bundles.members) {
        const int32_t node = node_of[static_cast<size_t>(member.bundle)];
        if (node < 0) continue;
        const CutClip& clip = bundles.clips[static_cast<size_t>(member.frames.clip)];
        const ClipPrimitive piece{
            .clip = clip.name,
            .first = source_boundary(clip, member.frames.first, bundles.pose_rate),
            .end = source_boundary(clip, member.frames.end, bundles.pose_rate),
            .cluster = member.bundle};
        if (piece.first < piece.end) members.push_back(piece);  // else shorter than a source frame
    }
    return members;
}

/// ρ that the bundles were made with.
double rho_of(const Generation& generation) {
    const auto& parts = generation.ledger().find("bundles.h5")->key.parts();
    const auto rho = std::ranges::find(parts, "option rho", &StageKey::Part::first);
    if (rho == parts.end()) throw StoreError("the key of bundles.h5 does not tell its rho");
    return std::stod(rho->second);
}

/// From where the take's segments end; nothing where that is there.
void add_transition(SegmentedTake& take, int64_t end) {
    const int64_t first = take.segments.empty() ? 0 : take.segments.back().frames.end;
    if (first < end) take.segments.push_back({{first, end}, SegmentKind::transition});
}

int64_t height_of(const StoredGraph& graph, int32_t node) {
    return static_cast<int64_t>(graph.nodes.graph.members(node).size());
}

int64_t takes_of(const StoredGraph& graph, int32_t node) {
    std::set<int32_t> takes;
    for (const int32_t piece : graph.nodes.graph.members(node)) {
        takes.insert(graph.nodes.graph.piece(piece).clip);
    }
    return static_cast<int64_t>(takes.size());
}

}  // namespace

std::vector<ClipPrimitive> stored_bundle_members(const OpenStore& open,
                                                 const std::filesystem::path& labels) {
    std::vector<ClipPrimitive> members = node_members(open.generation);
    label_from_table(members, open, labels);
    return members;
}

std::vector<ClusterLink> stored_bundle_links(const Generation& generation) {
    const StoredBundles bundles = read_bundles(generation.open("bundles.h5"));
    const StoredBundleGraph graph = read_bundle_graph(generation.open("bundle_graph.h5"), bundles);
    std::vector<int32_t> bundle_of;  // by node
    for (size_t bundle = 0; bundle < graph.node_of.size(); ++bundle) {
        if (graph.node_of[bundle] >= 0) bundle_of.push_back(static_cast<int32_t>(bundle));
    }
    std::vector<ClusterLink> links;
    for (const BundleLink& link : graph.links) {
        links.push_back({bundle_of[static_cast<size_t>(link.first)],
                         bundle_of[static_cast<size_t>(link.second)]});
    }
    return links;
}

Table bundle_list(const OpenStore& open, const std::filesystem::path& labels) {
    const Generation& generation = open.generation;
    Table table{{"bundle", "label", "height", "width", "volume", "takes"}, {}};
    std::vector<ClipPrimitive> members = stored_bundle_members(open, labels);
    if (members.empty()) return table;
    const WalkOptions walk = options_of_bundle_walk({});
    const StoredGraph graph =
        stored_graph(std::move(members), clip_source(generation), walk.longest_gap, walk.style);
    const double rho = rho_of(generation);
    std::vector<std::pair<double, int32_t>> largest_first;
    for (int32_t node = 0; node < graph.nodes.graph.nodes(); ++node) {
        largest_first.emplace_back(
            -bundle_volume(height_of(graph, node), graph.nodes.graph.mean_frames(node), rho), node);
    }
    std::ranges::sort(largest_first);
    for (const auto& [volume, node] : largest_first) {
        const auto at = static_cast<size_t>(node);
        table.rows.push_back({int64_t{graph.nodes.cluster_of[at]}, graph.nodes.label_of[at],
                              height_of(graph, node), graph.nodes.graph.mean_frames(node), -volume,
                              takes_of(graph, node)});
    }
    return table;
}

BundleShares bundle_shares(const Generation& generation) {
    const StoredBundles bundles = read_bundles(generation.open("bundles.h5"));
    return {.frames = read_bundle_graph(generation.open("bundle_graph.h5"), bundles).bundles.frames,
            .file_bytes = generation.ledger().find("bundles.h5")->file.bytes};
}

BundleScore stored_bundle_score(const Generation& generation, std::span<const TruthRow> truth) {
    std::map<std::string, int32_t> clip_numbers, class_numbers;
    std::vector<FrameClasses> classes;
    for (const CatalogClip& clip : generation.catalog().clips) {
        if (!clip.indexed()) continue;
        clip_numbers[clip.name] = static_cast<int32_t>(classes.size());
        classes.emplace_back();
        for (const TruthRow& row : truth) {
            if (row.clip != clip.name) continue;
            FrameClasses& labels = classes.back();
            labels.resize(static_cast<size_t>(clip.frames), no_class);
            const auto next = static_cast<int32_t>(class_numbers.size());
            const int32_t label = class_numbers.try_emplace(row.label, next).first->second;
            for (int64_t frame = row.first; frame < std::min(row.end, clip.frames); ++frame)
                labels[static_cast<size_t>(frame)] = label;
        }
    }
    if (class_numbers.empty()) throw UsageError("none of the annotated takes is in the store");
    std::vector<MotionPiece> members;
    std::vector<int32_t> bundle_of;
    for (const ClipPrimitive& member : node_members(generation)) {
        members.push_back({clip_numbers.at(member.clip), member.first, member.end});
        bundle_of.push_back(member.cluster);
    }
    return score_bundles(members, bundle_of, classes);
}

std::vector<SegmentedTake> stored_bundle_segments(const Generation& generation) {
    std::map<std::string, SegmentedTake> takes;
    for (const CatalogClip& clip : generation.catalog().clips) {
        if (clip.indexed()) takes[clip.name] = {clip.name, clip.frames, clip.rate, {}};
    }
    for (const ClipPrimitive& member : node_members(generation)) {
        SegmentedTake& take = takes.at(member.clip);
        add_transition(take, member.first);
        take.segments.push_back(
            {{member.first, member.end}, SegmentKind::activity, member.cluster});
    }
    std::vector<SegmentedTake> all;
    for (auto& [name, take] : takes) {
        add_transition(take, take.frames);
        all.push_back(std::move(take));
    }
    return all;
}

Table bundle_score_table(const BundleScore& score) {
    return {{"bundles", "purity", "shuffled", "chance", "coverage", "mean_height", "median_width"},
            {{score.bundles, score.purity, score.shuffled, score.chance, score.coverage,
              score.mean_height, score.median_width}}};
}

WalkOptions options_of_bundle_walk(WalkOptions options) {
    constexpr double longer_than_any_take = 1e6;  // seconds
    options.fade_seconds = longer_than_any_take;
    options.longest_gap = longer_than_any_take;
    options.style = {
        .piece = "member",
        .group = "bundle",
        .listing = "`kinetome bundles STORE --labels F` lists those of several members",
        .boxes_by_size = true};
    return options;
}

}  // namespace kinetome
