#include "kinetome/stages/stored_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <stdexcept>

#include "kinetome/base/csv.h"
#include "kinetome/base/error.h"
#include "kinetome/report/graph_svg.h"
#include "kinetome/store/json_text.h"

namespace kinetome {
namespace {

MotionPiece at_rate(const ClipPrimitive& primitive, int32_t clip, double factor) {
    const auto scaled = [=](int64_t frame) {
        return std::llround(static_cast<double>(frame) * factor);
    };
    return {clip, scaled(primitive.first), scaled(primitive.end)};
}

const ClipPrimitive& primitive_of(const StoredGraph& graph, int32_t piece) {
    return graph.primitives[static_cast<size_t>(piece)];
}

int32_t cluster_of(const StoredGraph& graph, int32_t node) {
    return graph.nodes.cluster_of[static_cast<size_t>(node)];
}

const std::string& label_of(const StoredGraph& graph, int32_t node) {
    return graph.nodes.label_of[static_cast<size_t>(node)];
}

/// Calls visit(from, to, successions) for every edge, by node.
template <class Visit>
void for_each_edge(const MotionGraph& graph, const Visit& visit) {
    for (int32_t from = 0; from < graph.nodes(); ++from) {
        const auto targets = graph.targets(from);
        for (size_t edge = 0; edge < targets.size(); ++edge) {
            visit(from, targets[edge], graph.successions(from, static_cast<int64_t>(edge)));
        }
    }
}

std::string write_csv(const StoredGraph& graph) {
    std::string text;
    const std::string& group = graph.nodes.style.group;
    append_csv_line(text, {"from_node", "to_node", "from_" + group, "to_" + group, "from_label",
                           "to_label", "clip", "from_first", "from_end", "to_first", "to_end"});
    const auto number = [](int64_t value) { return std::to_string(value); };
    for_each_edge(graph.nodes.graph, [&](int32_t from, int32_t to, const auto& successions) {
        for (const Succession& one : successions) {
            const ClipPrimitive& primitive = primitive_of(graph, one.piece);
            const ClipPrimitive& next = primitive_of(graph, one.next);
            append_csv_line(text, {number(from), number(to), number(cluster_of(graph, from)),
                                   number(cluster_of(graph, to)), csv_text(label_of(graph, from)),
                                   csv_text(label_of(graph, to)), csv_text(primitive.clip),
                                   number(primitive.first), number(primitive.end),
                                   number(next.first), number(next.end)});
        }
    });
    return text;
}

std::string write_json(const StoredGraph& graph) {
    const StrongComponents components = strong_components(graph.nodes.graph);
    const GraphStyle& style = graph.nodes.style;
    Json nodes = Json::array(), edges = Json::array();
    for (int32_t node = 0; node < graph.nodes.graph.nodes(); ++node) {
        Json pieces = Json::array();
        for (const int32_t piece : graph.nodes.graph.members(node)) {
            const ClipPrimitive& one = primitive_of(graph, piece);
            pieces.push_back({{"clip", one.clip}, {"first", one.first}, {"end", one.end}});
        }
        nodes.push_back({{"node", node},
                         {style.group, cluster_of(graph, node)},
                         {"label", label_of(graph, node)},
                         {"component", components.component_of[static_cast<size_t>(node)]},
                         {style.piece + "s", std::move(pieces)}});
    }
    for_each_edge(graph.nodes.graph, [&](int32_t from, int32_t to, const auto& successions) {
        edges.push_back({{"from", from}, {"to", to}, {"successions", successions.size()}});
    });
    Json links = Json::array();
    for (const NodeLink& link : graph.nodes.graph.links()) {
        links.push_back({{"first", link.first}, {"second", link.second}});
    }
    const Json whole = {
        {"nodes", std::move(nodes)}, {"edges", std::move(edges)}, {"links", std::move(links)}};
    // Bytes that are no UTF-8 have no JSON: a reader gets U+FFFD.
    return whole.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// In double quotes, as DOT has it; control characters are left out.
std::string dot_text(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') quoted += '\\';
        if (static_cast<unsigned char>(c) >= ' ') quoted += c;
    }
    return quoted + '"';
}

/// Inches: two a second of the mean length, half of one for the first piece.
std::string box_size(const StoredGraph& graph, int32_t node) {
    const MotionGraph& motions = graph.nodes.graph;
    return fmt::format(", fixedsize=true, width={:.2f}, height={:.2f}",
                       2 * motions.mean_frames(node) / graph.rate,
                       std::sqrt(static_cast<double>(motions.members(node).size())) / 2);
}

/// What a graph is called after.
const std::string& kind_of(const GraphStyle& style) {
    return style.boxes_by_size ? style.group : style.piece;
}

std::string write_dot(const StoredGraph& graph) {
    const GraphStyle& style = graph.nodes.style;
    std::string text = fmt::format("digraph {}s {{\n  node [shape=box];\n", kind_of(style));
    for (int32_t node = 0; node < graph.nodes.graph.nodes(); ++node) {
        const auto members = graph.nodes.graph.members(node);
        const std::string caption =
            fmt::format("{}: {} {}{}", graph.nodes.name_of(node), members.size(), style.piece,
                        members.size() == 1 ? "" : "s");
        fmt::format_to(std::back_inserter(text), "  n{} [label={}{}];\n", node, dot_text(caption),
                       style.boxes_by_size ? box_size(graph, node) : "");
    }
    for_each_edge(graph.nodes.graph, [&](int32_t from, int32_t to, const auto& successions) {
        fmt::format_to(std::back_inserter(text), "  n{} -> n{} [label={}];\n", from, to,
                       successions.size());
    });
    for (const NodeLink& link : graph.nodes.graph.links()) {
        fmt::format_to(std::back_inserter(text),
                       "  n{} -> n{} [dir=none, style=dashed, constraint=false];\n", link.first,
                       link.second);
    }
    return text + "}\n";
}

}  // namespace

StoredGraph stored_graph(std::vector<ClipPrimitive> primitives, const ClipSource& source,
                         double longest_gap, const GraphStyle& style) {
    if (primitives.empty()) {
        throw UsageError(
            fmt::format("the store has no {}s: nothing in its takes recurs", kind_of(style)));
    }
    StoredGraph graph;
    std::map<std::string, int32_t> numbers;
    std::map<std::string, double> rate_of;
    std::map<double, int64_t> rates;
    for (const ClipPrimitive& primitive : primitives) {
        const auto number = static_cast<int32_t>(graph.clips.size());
        if (numbers.try_emplace(primitive.clip, number).second) {
            graph.clips.push_back(primitive.clip);
            rate_of[primitive.clip] = source.kind(primitive.clip).rate;
        }
        ++rates[rate_of[primitive.clip]];
    }
    graph.rate =
        std::ranges::max_element(rates, {}, [](const auto& one) { return one.second; })->first;
    std::vector<MotionPiece> pieces;
    std::vector<int32_t> clusters;
    std::vector<std::string> labels;
    for (const ClipPrimitive& primitive : primitives) {
        pieces.push_back(
            at_rate(primitive, numbers[primitive.clip], graph.rate / rate_of[primitive.clip]));
        clusters.push_back(primitive.cluster);
        labels.push_back(primitive.label);
    }
    graph.nodes = primitive_graph(std::move(pieces), clusters, labels,
                                  std::llround(longest_gap * graph.rate));
    graph.nodes.style = style;
    graph.primitives = std::move(primitives);
    return graph;
}

void link_clusters(StoredGraph& graph, const std::vector<ClusterLink>& links) {
    std::map<int32_t, int32_t> node_of;
    for (int32_t node = 0; node < graph.nodes.graph.nodes(); ++node)
        node_of[cluster_of(graph, node)] = node;
    std::vector<NodeLink> nodes;
    for (const auto& [first, second] : links) {
        const auto one = node_of.find(first), other = node_of.find(second);
        if (one != node_of.end() && other != node_of.end())
            nodes.push_back({one->second, other->second});
    }
    graph.nodes.graph.link(nodes);
}

GraphFormat parse_graph_format(std::string_view name) {
    if (name == "csv") return GraphFormat::csv;
    if (name == "json") return GraphFormat::json;
    if (name == "dot") return GraphFormat::dot;
    if (name == "svg") return GraphFormat::svg;
    throw UsageError(fmt::format("--format {}: expected csv, json, dot or svg", name));
}

std::string write_graph(const StoredGraph& graph, GraphFormat format) {
    switch (format) {
        case GraphFormat::csv:
            return write_csv(graph);
        case GraphFormat::json:
            return write_json(graph);
        case GraphFormat::dot:
            return write_dot(graph);
        case GraphFormat::svg:
            return graph_svg(fmt::format("Graph of {}s", kind_of(graph.nodes.style)), graph.nodes,
                             graph.rate);
    }
    throw std::logic_error("no such format of graphs");
}

}  // namespace kinetome
