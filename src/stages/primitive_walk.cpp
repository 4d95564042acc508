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

/// What most of the items have; of equally frequent ones the lowest.
template <class Key>
Key most_frequent(const std::map<Key, int64_t>& counts) {
    return std::ranges::max_element(counts, {}, [](const auto& one) { return one.second; })->first;
}

bool is_named(const ClipPrimitive& primitive, const std::string& name) {
    return primitive.label == name || std::to_string(primitive.cluster) == name;
}

MotionPiece at_rate(const ClipPrimitive& primitive, int32_t clip, double factor) {
    const auto scaled = [&](int64_t frame) {
        return std::llround(static_cast<double>(frame) * factor);
    };
    return {clip, scaled(primitive.first), scaled(primitive.end)};
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
    ClipsOfOneBody(const ClassGraph& graph, const ClipSource& source, const WalkOptions& options,
                   const std::vector<MotionRun>& runs)
        : body_(options.body) {
        if (body_.empty()) body_ = graph.clips[static_cast<size_t>(runs.front().clip)];
        const std::string body_class = source.kind(body_).clip_class;
        if (body_class != graph.clip_class) {
            throw UsageError(
                fmt::format("--body {}: it is of class {}, the walk's primitives of "
                            "class {}; name a clip of that class",
                            quote_for_message(body_), body_class, graph.clip_class));
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

ClassGraph class_graph(const std::vector<ClipPrimitive>& primitives, const ClipSource& source,
                       const WalkOptions& options) {
    std::map<std::string, ClipKind> kinds;
    for (const ClipPrimitive& primitive : primitives) {
        if (!kinds.contains(primitive.clip)) kinds[primitive.clip] = source.kind(primitive.clip);
    }
    std::map<std::string, int64_t> classes;
    for (const ClipPrimitive& primitive : primitives) {
        if (options.from.empty() || is_named(primitive, options.from)) {
            ++classes[kinds[primitive.clip].clip_class];
        }
    }
    if (primitives.empty()) {
        throw UsageError("the store has no primitives; kinetome reindex makes them");
    }
    if (classes.empty()) {
        throw UsageError(
            fmt::format("--from {}: no primitive has this label or cluster; kinetome "
                        "export STORE primitives lists them",
                        quote_for_message(options.from)));
    }
    ClassGraph result;
    result.clip_class = most_frequent(classes);
    std::map<double, int64_t> rates;
    std::map<std::string, int32_t> numbers;
    for (const ClipPrimitive& primitive : primitives) {
        const ClipKind& kind = kinds[primitive.clip];
        if (kind.clip_class != result.clip_class) continue;
        ++rates[kind.rate];
        result.pieces.push_back(primitive);
        if (numbers.try_emplace(primitive.clip, static_cast<int32_t>(result.clips.size())).second) {
            result.clips.push_back(primitive.clip);
        }
    }
    result.rate = most_frequent(rates);
    std::vector<MotionPiece> pieces;
    std::vector<int32_t> clusters;
    std::vector<std::string> labels;
    for (const ClipPrimitive& primitive : result.pieces) {
        pieces.push_back(
            at_rate(primitive, numbers[primitive.clip], result.rate / kinds[primitive.clip].rate));
        clusters.push_back(primitive.cluster);
        labels.push_back(primitive.label);
    }
    result.primitives = primitive_graph(std::move(pieces), clusters, labels,
                                        std::llround(options.longest_gap * result.rate));
    return result;
}

PrimitiveWalk walk_primitives(const ClassGraph& graph, const ClipSource& source,
                              const WalkOptions& options) {
    check(options);
    const auto from = require_nodes(graph.primitives, "--from", options.from);
    const auto to = require_nodes(graph.primitives, "--to", options.to);
    require_path(graph.primitives, options, from, to);
    const GraphWalk way = random_walk(
        graph.primitives.graph,
        {.frames = options.seconds * graph.rate, .seed = options.seed, .from = from, .to = to});
    const ClipsOfOneBody played(
        graph, source, options,
        runs_of_walk(graph.primitives.graph, way.steps, options.fade_seconds * graph.rate));
    PrimitiveWalk walk{.motion = play_runs(played.clips(), played.runs()),
                       .body = played.body(),
                       .ended_early = way.ended_early};
    walk.quality = measure_walk(played.clips(), played.runs(), walk.motion);
    for (const WalkStep& step : way.steps) {
        walk.path.push_back(graph.pieces[static_cast<size_t>(step.entry)]);
        walk.nodes.push_back(graph.primitives.name_of(step.node));
    }
    const int64_t wanted = std::llround(options.seconds * graph.rate);
    if (to.empty() && walk.motion.frames() > wanted) {
        walk.motion.motion.conservativeResize(std::max<int64_t>(wanted, 1), Eigen::NoChange);
    }
    return walk;
}

}  // namespace kinetome
