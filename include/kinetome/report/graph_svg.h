// A motion graph drawn as boxes and arrows (S1 Fig. 4, S3 §6.2).
#pragma once

#include <string>

#include "kinetome/models/primitive_graph.h"

namespace kinetome {

/// One self-contained picture, the same text for the same graph. A node is a box, by
/// style.boxes_by_size as wide as its mean length and as high as the root of its number of pieces
/// (√B_h × B_w of S1), else as wide as its name; nodes that a walk can come back to are blue,
/// others grey. Nodes that arrows join lie on one ring, in an order that follows the most frequent
/// successions; linked nodes are joined by dashed lines. Names are written into boxes with room for
/// them and shown when pointed at. `rate`: frames a second of the graph's pieces.
std::string graph_svg(const std::string& title, const PrimitiveGraph& graph, double rate);

}  // namespace kinetome
