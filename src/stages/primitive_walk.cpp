#include "kinetome/stages/primitive_walk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"
#include "walk_clips.h"

namespace kinetome {
namespace {

/// Labels of the nodes, and the numbers of clusters without one; as many as a message can hold.
std::string listed(const PrimitiveGraph& primitives, const std::vector<int32_t>& nodes) {
    std::set<std::string> labels;
    std::set<int32_t> clusters;
    for (const int32_t node : nodes) {
        const std::string& label = primitives.label_of[static_cast<size_t>(node)];
        const int32_t cluster = primitives.cluster_of[static_cast<size_t>(node)];
        if (!label.empty()) {
            labels.insert(label);
        } else if (cluster >= 0) {
            clusters.insert(cluster);
        }
    }
    std::vector<std::string> names;
    for (const std::string& label : labels) names.push_back(quote_for_message(label));
    for (const int32_t cluster : clusters) names.push_back(std::to_string(cluster));
    constexpr size_t most = 12;
    const bool all = names.size() <= most;
    if (!all) names.resize(most);
    return fmt::format("{}{}", fmt::join(names, ", "), all ? "" : ", …");
}

std::vector<int32_t> all_nodes(const PrimitiveGraph& primitives) {
    std::vector<int32_t> nodes;
    for (int32_t node = 0; node < primitives.graph.nodes(); ++node) nodes.push_back(node);
    return nodes;
}

std::vector<int32_t> require_nodes(const PrimitiveGraph& primitives, const char* option,
                                   const std::string& name) {
    if (name.empty()) return {};
    auto nodes = primitives.nodes_named(name);
    if (nodes.empty()) {
        const GraphStyle& style = primitives.style;
        throw UsageError(fmt::format("{} {}: no {} has this label or {}; there are {}", option,
                                     quote_for_message(name), style.piece, style.group,
                                     listed(primitives, all_nodes(primitives))));
    }
    return nodes;
}

void require_path(const PrimitiveGraph& primitives, const WalkOptions& options,
                  const std::vector<int32_t>& from, const std::vector<int32_t>& to) {
    if (from.empty() || to.empty()) return;
    if (!shortest_path(primitives.graph, from, primitives.graph.with_linked(to)).empty()) return;
    const auto reached = nodes_reached(primitives.graph, from);
    std::vector<int32_t> there;
    for (const int32_t node : all_nodes(primitives)) {
        if (reached[static_cast<size_t>(node)]) there.push_back(node);
    }
    throw UsageError(fmt::format(
        "no path from {} to {}: takes lead from there to {} only; choose "
        "--to among these, or leave --from out",
        quote_for_message(options.from), quote_for_message(options.to), listed(primitives, there)));
}

bool is_named(const ClipPrimitive& primitive, const std::string& name) {
    return primitive.label == name || std::to_string(primitive.cluster) == name;
}

/// Those of the class of skeletons that most of the named ones have.
std::vector<ClipPrimitive> of_one_class(const std::vector<ClipPrimitive>& primitives,
                                        const ClipSource& source, const std::string& from) {
    std::map<std::string, std::string> class_of;  // by clip
    for (const ClipPrimitive& primitive : primitives) {
        std::string& clip_class = class_of[primitive.clip];
        if (clip_class.empty()) clip_class = source.kind(primitive.clip).clip_class;
    }
    std::map<std::string, int64_t> counts;
    for (const ClipPrimitive& primitive : primitives) {
        if (from.empty() || is_named(primitive, from)) ++counts[class_of[primitive.clip]];
    }
    if (counts.empty()) return primitives;  // none is named: whoever looks for them will say so
    const auto most =
        std::ranges::max_element(counts, {}, [](const auto& one) { return one.second; });
    std::vector<ClipPrimitive> kept;
    for (const ClipPrimitive& primitive : primitives) {
        if (class_of[primitive.clip] == most->first) kept.push_back(primitive);
    }
    return kept;
}

void check(const WalkOptions& options) {
    if (!(options.seconds > 0) || !std::isfinite(options.seconds)) {
        throw UsageError("--seconds: expected a positive number");
    }
    if (!(options.fade_seconds >= 0)) throw UsageError("--fade: expected seconds, 0 or more");
}

}  // namespace

PrimitiveWalk walk_primitives(const std::vector<ClipPrimitive>& primitives,
                              const ClipSource& source, const WalkOptions& options,
                              const std::vector<ClusterLink>& links) {
    check(options);
    StoredGraph graph = stored_graph(of_one_class(primitives, source, options.from), source,
                                     options.longest_gap, options.style);
    link_clusters(graph, links);
    const MotionGraph& pieces = graph.nodes.graph;
    const auto from = require_nodes(graph.nodes, "--from", options.from);
    const auto to = require_nodes(graph.nodes, "--to", options.to);
    require_path(graph.nodes, options, from, to);

    const double wanted = options.seconds * graph.rate;
    WalkRequest request{.frames = wanted, .seed = options.seed, .from = from, .to = to};
    const MotionPiece& first = pieces.piece(random_walk(pieces, request).steps.front().entry);
    WalkClips clips(
        graph, source, options,
        options.body.empty() ? graph.clips[static_cast<size_t>(first.clip)] : options.body);
    request.excess = [&](int32_t entry, int32_t exit) { return clips.excess(entry, exit); };
    GraphWalk way;
    std::vector<MotionRun> runs;
    PrimitiveWalk walk{.motion = {}, .body = clips.body()};
    do {
        way = random_walk(pieces, request);
        runs = clips.runs(way);
        // Going over early in one piece and late in the next makes a walk shorter than it was
        // planned.
        while (frames_of_runs(runs) < wanted && !way.ended_early) {
            request.frames += wanted - frames_of_runs(runs) + 1;
            way = random_walk(pieces, request);
            runs = clips.runs(way);
        }
        walk.motion = play_runs(clips.clips(), runs, clips.supports());
    } while (clips.mend(way, runs, walk.motion));
    walk.ended_early = frames_of_runs(runs) < wanted;
    walk.quality = measure_walk(clips.clips(), runs, walk.motion);
    for (const WalkStep& step : way.steps) {
        walk.path.push_back(graph.primitives[static_cast<size_t>(step.entry)]);
        walk.nodes.push_back(graph.nodes.name_of(step.node));
        const int32_t left = pieces.node_of(step.exit);
        if (left != step.node) walk.nodes.push_back(graph.nodes.name_of(left));
    }
    const auto kept = std::max<int64_t>(std::llround(wanted), 1);
    if (to.empty() && walk.motion.frames() > kept) {
        walk.motion.motion.conservativeResize(kept, Eigen::NoChange);
    }
    return walk;
}

}  // namespace kinetome
