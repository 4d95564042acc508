#include "kinetome/models/primitive_graph.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <stdexcept>

namespace kinetome {
namespace {

std::string most_frequent(const std::map<std::string, int64_t>& counts) {
    std::string best;
    int64_t most = 0;
    for (const auto& [label, count] : counts) {
        if (count > most) best = label;
        most = std::max(most, count);
    }
    return best;
}

}  // namespace

PrimitiveGraph primitive_graph(std::vector<MotionPiece> primitives,
                               std::span<const int32_t> clusters,
                               std::span<const std::string> labels, int64_t longest_gap) {
    if (clusters.size() != primitives.size() ||
        (!labels.empty() && labels.size() != primitives.size())) {
        throw std::invalid_argument("primitives, their clusters and their labels disagree");
    }
    PrimitiveGraph result;
    std::map<int32_t, int32_t> node_of_cluster;
    for (const int32_t cluster : clusters) {
        if (cluster >= 0) node_of_cluster[cluster] = 0;
    }
    for (auto& [cluster, node] : node_of_cluster) {
        node = static_cast<int32_t>(result.cluster_of.size());
        result.cluster_of.push_back(cluster);
    }
    std::vector<int32_t> node_of;
    for (const int32_t cluster : clusters) {
        if (cluster < 0) {
            node_of.push_back(static_cast<int32_t>(result.cluster_of.size()));
            result.cluster_of.push_back(-1);
        } else {
            node_of.push_back(node_of_cluster.at(cluster));
        }
    }
    std::vector<std::map<std::string, int64_t>> counts(result.cluster_of.size());
    for (size_t i = 0; i < labels.size(); ++i) {
        if (!labels[i].empty()) ++counts[static_cast<size_t>(node_of[i])][labels[i]];
    }
    for (const auto& of_node : counts) result.label_of.push_back(most_frequent(of_node));
    result.graph = MotionGraph(std::move(primitives), std::move(node_of),
                               static_cast<int32_t>(counts.size()), longest_gap);
    return result;
}

std::vector<int32_t> PrimitiveGraph::nodes_named(std::string_view label_or_cluster) const {
    std::vector<int32_t> nodes;
    if (label_or_cluster.empty()) return nodes;
    for (int32_t node = 0; node < graph.nodes(); ++node) {
        if (label_of[static_cast<size_t>(node)] == label_or_cluster) nodes.push_back(node);
    }
    if (!nodes.empty()) return nodes;
    int32_t cluster = -1;
    const char* const end = label_or_cluster.data() + label_or_cluster.size();
    const auto parsed = std::from_chars(label_or_cluster.data(), end, cluster);
    if (parsed.ec != std::errc() || parsed.ptr != end || cluster < 0) return nodes;
    const auto found = std::ranges::find(cluster_of, cluster);
    if (found != cluster_of.end())
        nodes.push_back(static_cast<int32_t>(found - cluster_of.begin()));
    return nodes;
}

std::string PrimitiveGraph::name_of(int32_t node) const {
    const std::string& label = label_of[static_cast<size_t>(node)];
    const int32_t cluster = cluster_of[static_cast<size_t>(node)];
    if (cluster < 0) return label.empty() ? "a " + style.piece + " of no " + style.group : label;
    const std::string number = style.group + " " + std::to_string(cluster);
    return label.empty() ? number : label + " (" + number + ")";
}

}  // namespace kinetome
