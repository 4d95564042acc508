#include "kinetome/stages/primitive_walk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"
#include "kinetome/formats/resample.h"
#include "kinetome/models/graph_walk.h"
#include "kinetome/models/retarget.h"

namespace kinetome {
namespace {

/// Names in words, as many as a message can hold.
std::string listed(const std::set<std::string>& names) {
    constexpr size_t most = 12;
    std::string text;
    size_t count = 0;
    for (const std::string& name : names) {
        if (count++ == most) return text + ", …";
        text += (text.empty() ? "" : ", ") + quote_for_message(name);
    }
    return text;
}

std::set<std::string> names_of(const PrimitiveGraph& primitives,
                               const std::vector<int32_t>& nodes) {
    std::set<std::string> names;
    for (const int32_t node : nodes) {
        const std::string& label = primitives.label_of[static_cast<size_t>(node)];
        const int32_t cluster = primitives.cluster_of[static_cast<size_t>(node)];
        if (!label.empty()) {
            names.insert(label);
        } else if (cluster >= 0) {
            names.insert(std::to_string(cluster));
        }
    }
    return names;
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
        throw UsageError(fmt::format("{} {}: no primitive has this label or cluster; there are {}",
                                     option, quote_for_message(name),
                                     listed(names_of(primitives, all_nodes(primitives)))));
    }
    return nodes;
}

void require_path(const PrimitiveGraph& primitives, const WalkOptions& options,
                  const std::vector<int32_t>& from, const std::vector<int32_t>& to) {
    if (from.empty() || to.empty()) return;
    if (!shortest_path(primitives.graph, from, to).empty()) return;
    const auto reached = nodes_reached(primitives.graph, from);
    std::vector<int32_t> there;
    for (const int32_t node : all_nodes(primitives)) {
        if (reached[static_cast<size_t>(node)]) there.push_back(node);
    }
    throw UsageError(
        fmt::format("no path from {} to {}: takes lead from there to {} only; choose "
                    "--to among these, or leave --from out",
                    quote_for_message(options.from), quote_for_message(options.to),
                    listed(names_of(primitives, there))));
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

/// The clips of a walk on one body, at one rate, numbered as they come in.
class ClipsOfOneBody {
  public:
    ClipsOfOneBody(const StoredGraph& graph, const ClipSource& source, const WalkOptions& options,
                   const std::vector<MotionRun>& runs)
        : body_(options.body) {
        if (body_.empty()) body_ = graph.clips[static_cast<size_t>(runs.front().clip)];
        const std::string body_class = source.kind(body_).clip_class;
        const std::string clip_class = source.kind(graph.clips.front()).clip_class;
        if (body_class != clip_class) {
            throw UsageError(
                fmt::format("--body {}: it is of class {}, the walk's primitives of "
                            "class {}; name a clip of that class",
                            quote_for_message(body_), body_class, clip_class));
        }
        const auto skeleton = source.read(body_).skeleton;
        std::map<int32_t, int32_t> numbers;
        for (MotionRun run : runs) {
            const auto [known, is_new] =
                numbers.try_emplace(run.clip, static_cast<int32_t>(clips_.size()));
            if (is_new) {
                const Clip clip = source.read(graph.clips[static_cast<size_t>(run.clip)]);
                clips_.push_back(retarget(resample(clip, graph.rate), skeleton));
            }
            run.clip = known->second;
            runs_.push_back(run);
        }
    }

    const std::string& body() const { return body_; }
    const std::vector<Clip>& clips() const { return clips_; }
    const std::vector<MotionRun>& runs() const { return runs_; }

  private:
    std::string body_;
    std::vector<Clip> clips_;
    std::vector<MotionRun> runs_;
};

}  // namespace

PrimitiveWalk walk_primitives(const std::vector<ClipPrimitive>& primitives,
                              const ClipSource& source, const WalkOptions& options) {
    check(options);
    const StoredGraph graph =
        stored_graph(of_one_class(primitives, source, options.from), source, options.longest_gap);
    const MotionGraph& pieces = graph.nodes.graph;
    const auto from = require_nodes(graph.nodes, "--from", options.from);
    const auto to = require_nodes(graph.nodes, "--to", options.to);
    require_path(graph.nodes, options, from, to);
    const GraphWalk way = random_walk(
        pieces,
        {.frames = options.seconds * graph.rate, .seed = options.seed, .from = from, .to = to});
    const ClipsOfOneBody played(graph, source, options,
                                runs_of_walk(pieces, way.steps, options.fade_seconds * graph.rate));
    PrimitiveWalk walk{.motion = play_runs(played.clips(), played.runs()),
                       .body = played.body(),
                       .ended_early = way.ended_early};
    walk.quality = measure_walk(played.clips(), played.runs(), walk.motion);
    for (const WalkStep& step : way.steps) {
        walk.path.push_back(graph.primitives[static_cast<size_t>(step.entry)]);
        walk.nodes.push_back(graph.nodes.name_of(step.node));
    }
    const int64_t wanted = std::llround(options.seconds * graph.rate);
    if (to.empty() && walk.motion.frames() > wanted) {
        walk.motion.motion.conservativeResize(std::max<int64_t>(wanted, 1), Eigen::NoChange);
    }
    return walk;
}

}  // namespace kinetome
