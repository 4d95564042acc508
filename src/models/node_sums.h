// Sums for each node of a tree, over those pieces of a corpus where the node has rows: nodes that
// are absent cost nothing, and what is summed of one node never depends on which others are.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "kinetome/base/packing.h"
#include "kinetome/base/piece_sum.h"

namespace kinetome {

/// By place in the list of nodes that a pass is about, ascending; Value has merge, pack and unpack.
template <class Value>
struct NodeSums {
    std::vector<std::pair<int32_t, Value>> sums;
};

template <class Value>
void merge(NodeSums<Value>& left, const NodeSums<Value>& right) {
    std::vector<std::pair<int32_t, Value>> both;
    both.reserve(left.sums.size() + right.sums.size());
    auto a = left.sums.begin();
    for (const auto& [node, value] : right.sums) {
        while (a != left.sums.end() && a->first < node) both.push_back(std::move(*a++));
        if (a != left.sums.end() && a->first == node) {
            merge(a->second, value);
            both.push_back(std::move(*a++));
        } else {
            both.emplace_back(node, value);
        }
    }
    while (a != left.sums.end()) both.push_back(std::move(*a++));
    left.sums = std::move(both);
}

template <class Value>
void pack(Packer& out, const NodeSums<Value>& sums) {
    out.put(static_cast<uint64_t>(sums.sums.size()));
    for (const auto& [node, value] : sums.sums) {
        out.put(node);
        pack(out, value);
    }
}

template <class Value>
void unpack(Unpacker& in, NodeSums<Value>& sums) {
    sums.sums.clear();
    for (auto left = in.get<uint64_t>(); left > 0; --left) {
        auto& [node, value] = sums.sums.emplace_back();
        unpack(in, node);
        unpack(in, value);
    }
}

/// Over all pieces; what of_piece(range) says of one. The same at every rank.
template <class Value, class OfPiece>
NodeSums<Value> sum_nodes(const Workers& workers, const PieceLayout& layout, OfPiece&& of_piece) {
    auto sums = sum_pieces<NodeSums<Value>>(
        workers, layout, of_piece,
        [](NodeSums<Value>& left, const NodeSums<Value>& right) { merge(left, right); });
    return sums ? *std::move(sums) : NodeSums<Value>{};
}

}  // namespace kinetome
