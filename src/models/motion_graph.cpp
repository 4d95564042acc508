#include "kinetome/models/motion_graph.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <stdexcept>
#include <tuple>

namespace kinetome {
namespace {

void check(const std::vector<MotionPiece>& pieces, const std::vector<int32_t>& node_of,
           int32_t nodes) {
    if (node_of.size() != pieces.size()) {
        throw std::invalid_argument("each piece of a motion graph needs a node");
    }
    if (std::ranges::any_of(pieces, [](const auto& piece) { return piece.frames() <= 0; })) {
        throw std::invalid_argument("a piece of a motion graph has no frames");
    }
    if (std::ranges::any_of(node_of, [=](int32_t node) { return node < 0 || node >= nodes; })) {
        throw std::invalid_argument("a piece of a motion graph names a node that is not there");
    }
}

/// Pairs of consecutive pieces of a clip, in the order of their clips.
std::vector<Succession> find_successions(const std::vector<MotionPiece>& pieces,
                                         int64_t longest_gap) {
    std::vector<int32_t> order(pieces.size());
    std::iota(order.begin(), order.end(), 0);
    const auto place = [&](int32_t i) {
        const MotionPiece& piece = pieces[static_cast<size_t>(i)];
        return std::tuple(piece.clip, piece.first, i);
    };
    std::ranges::sort(order, {}, place);
    std::vector<Succession> found;
    for (size_t i = 0; i + 1 < order.size(); ++i) {
        const MotionPiece& piece = pieces[static_cast<size_t>(order[i])];
        const MotionPiece& next = pieces[static_cast<size_t>(order[i + 1])];
        if (piece.clip != next.clip) continue;
        if (next.first < piece.end) {
            throw std::invalid_argument("pieces of a motion graph overlap in their clip");
        }
        if (next.first - piece.end <= longest_gap) found.push_back({order[i], order[i + 1]});
    }
    return found;
}

template <class T>
std::span<const T> part(const std::vector<T>& all, const std::vector<int64_t>& offsets, size_t i) {
    return std::span(all).subspan(static_cast<size_t>(offsets[i]),
                                  static_cast<size_t>(offsets[i + 1] - offsets[i]));
}

}  // namespace

MotionGraph::MotionGraph(std::vector<MotionPiece> pieces, std::vector<int32_t> node_of,
                         int32_t nodes, int64_t longest_gap)
    : pieces_(std::move(pieces)), node_of_(std::move(node_of)) {
    check(pieces_, node_of_, nodes);

    members_.resize(pieces_.size());
    std::iota(members_.begin(), members_.end(), 0);
    std::ranges::stable_sort(members_, {}, [&](int32_t piece) { return this->node_of(piece); });

    successions_ = find_successions(pieces_, longest_gap);
    const auto ends = [&](const Succession& one) {
        return std::tuple(this->node_of(one.piece), this->node_of(one.next), one.piece);
    };
    std::ranges::sort(successions_, {}, ends);

    size_t member = 0, succession = 0;
    for (int32_t node = 0; node < nodes; ++node) {
        while (member < members_.size() && this->node_of(members_[member]) == node) ++member;
        members_of_.push_back(static_cast<int64_t>(member));
        while (succession < successions_.size() &&
               this->node_of(successions_[succession].piece) == node) {
            const int32_t target = this->node_of(successions_[succession].next);
            const bool new_edge = edges() == edges_of_.back() || targets_.back() != target;
            if (new_edge) {
                targets_.push_back(target);
                successions_of_edge_.push_back(successions_of_edge_.back());
            }
            successions_of_edge_.back() = static_cast<int64_t>(++succession);
        }
        edges_of_.push_back(edges());
    }
    link({});
}

std::span<const int32_t> MotionGraph::members(int32_t node) const {
    return part(members_, members_of_, static_cast<size_t>(node));
}

double MotionGraph::mean_frames(int32_t node) const {
    int64_t frames = 0;
    for (const int32_t index : members(node)) frames += piece(index).frames();
    return static_cast<double>(frames) / static_cast<double>(members(node).size());
}

std::span<const int32_t> MotionGraph::targets(int32_t node) const {
    return part(targets_, edges_of_, static_cast<size_t>(node));
}

std::span<const Succession> MotionGraph::successions(int32_t node, int64_t edge) const {
    const int64_t number = edges_of_[static_cast<size_t>(node)] + edge;
    return part(successions_, successions_of_edge_, static_cast<size_t>(number));
}

std::span<const Succession> MotionGraph::successions(int32_t node) const {
    const auto first = static_cast<size_t>(edges_of_[static_cast<size_t>(node)]);
    const auto end = static_cast<size_t>(edges_of_[static_cast<size_t>(node) + 1]);
    return std::span(successions_)
        .subspan(static_cast<size_t>(successions_of_edge_[first]),
                 static_cast<size_t>(successions_of_edge_[end] - successions_of_edge_[first]));
}

void MotionGraph::link(std::span<const NodeLink> links) {
    std::vector<std::set<int32_t>> linked(static_cast<size_t>(nodes()));
    for (const auto& [first, second] : links) {
        if (std::min(first, second) < 0 || std::max(first, second) >= nodes() || first == second) {
            throw std::invalid_argument(
                "a link joins a node that is not there, or one with itself");
        }
        linked[static_cast<size_t>(first)].insert(second);
        linked[static_cast<size_t>(second)].insert(first);
    }
    linked_.clear();
    links_of_ = {0};
    for (const auto& of_node : linked) {
        linked_.insert(linked_.end(), of_node.begin(), of_node.end());
        links_of_.push_back(static_cast<int64_t>(linked_.size()));
    }
}

std::vector<NodeLink> MotionGraph::links() const {
    std::vector<NodeLink> links;
    for (int32_t node = 0; node < nodes(); ++node) {
        for (const int32_t other : linked(node)) {
            if (node < other) links.push_back({node, other});
        }
    }
    return links;
}

std::span<const int32_t> MotionGraph::linked(int32_t node) const {
    return part(linked_, links_of_, static_cast<size_t>(node));
}

std::vector<int32_t> MotionGraph::with_linked(std::span<const int32_t> nodes) const {
    std::set<int32_t> all(nodes.begin(), nodes.end());
    for (const int32_t node : nodes) all.insert(linked(node).begin(), linked(node).end());
    return {all.begin(), all.end()};
}

std::vector<Succession> MotionGraph::ways_on(int32_t node) const {
    const auto own = successions(node);
    std::vector<Succession> ways(own.begin(), own.end());
    for (const int32_t other : linked(node)) {
        ways.insert(ways.end(), successions(other).begin(), successions(other).end());
    }
    return ways;
}

std::vector<int32_t> MotionGraph::next_nodes(int32_t node) const {
    std::set<int32_t> next(targets(node).begin(), targets(node).end());
    for (const int32_t other : linked(node))
        next.insert(targets(other).begin(), targets(other).end());
    return {next.begin(), next.end()};
}

int64_t MotionGraph::gap(const Succession& succession) const {
    return piece(succession.next).first - piece(succession.piece).end;
}

}  // namespace kinetome
