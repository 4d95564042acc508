// The motion graph of primitives (S3 §6.2), in which each cluster of primitives is one node.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinetome/models/motion_graph.h"

namespace kinetome {

/// How a graph speaks of what it holds, and draws it.
struct GraphStyle {
    std::string piece = "primitive", group = "cluster";
    /// Where a message sends whoever looks for a node.
    std::string listing = "`kinetome export STORE primitives` lists them";
    /// Nodes as wide as their mean length, as high as the root of their number of pieces (S1 §4).
    bool boxes_by_size = false;
};

struct PrimitiveGraph {
    MotionGraph graph;                ///< its pieces are the primitives, in the order given
    std::vector<int32_t> cluster_of;  ///< by node; -1: a primitive like no other, alone in its node
    /// By node: the label that most of its primitives have, of equally many the first by alphabet;
    /// "" when none has one.
    std::vector<std::string> label_of;
    GraphStyle style = {};

    /// Nodes of that label, else of the cluster of that number, ascending.
    std::vector<int32_t> nodes_named(std::string_view label_or_cluster) const;
    /// "walk (cluster 3)", "cluster 3", "walk", "a primitive of no cluster".
    std::string name_of(int32_t node) const;
};

/// Nodes are the clusters by number, then the primitives without one (-1). One label a primitive,
/// "" where it is not known, or none at all. Throws std::invalid_argument when the numbers of
/// pieces, clusters and labels disagree, and what MotionGraph throws.
PrimitiveGraph primitive_graph(std::vector<MotionPiece> primitives,
                               std::span<const int32_t> clusters,
                               std::span<const std::string> labels, int64_t longest_gap);

}  // namespace kinetome
