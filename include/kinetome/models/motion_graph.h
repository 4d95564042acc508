// Which motions may follow each other: the graph that walks lead through, of primitive clusters
// (S3 §6.2) or of motion bundles (S1 §4).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kinetome {

/// Frames [first, end) of a clip, named by its number among the clips at hand. All pieces of a
/// graph count at one rate.
struct MotionPiece {
    int32_t clip = 0;
    int64_t first = 0, end = 0;

    int64_t frames() const { return end - first; }
    bool operator==(const MotionPiece&) const = default;
};

/// A piece and the one that follows it in its clip, at once or after frames that belong to neither.
struct Succession {
    int32_t piece = 0, next = 0;
    bool operator==(const Succession&) const = default;
};

/// Two nodes that hold the same motion of different bodies: pieces of the one may be exchanged for
/// pieces of the other, too.
struct NodeLink {
    int32_t first = 0, second = 0;
    bool operator==(const NodeLink&) const = default;
};

/// Nodes are groups of pieces so alike that one may be exchanged for another; an edge says that
/// some piece of the one node is followed by some piece of the other, and keeps all those that are.
class MotionGraph {
  public:
    MotionGraph() = default;
    /// `node_of` names the node of each piece, in [0, nodes). Pieces stand in any order, have
    /// frames, and do not overlap in their clip. A piece is followed by the next one of its clip
    /// unless more than `longest_gap` frames lie between. Throws std::invalid_argument.
    MotionGraph(std::vector<MotionPiece> pieces, std::vector<int32_t> node_of, int32_t nodes,
                int64_t longest_gap);

    int32_t nodes() const { return static_cast<int32_t>(members_of_.size()) - 1; }
    int64_t edges() const { return static_cast<int64_t>(targets_.size()); }

    const std::vector<MotionPiece>& pieces() const { return pieces_; }
    const MotionPiece& piece(int32_t index) const { return pieces_[static_cast<size_t>(index)]; }
    int32_t node_of(int32_t piece) const { return node_of_[static_cast<size_t>(piece)]; }
    /// Pieces of a node, ascending.
    std::span<const int32_t> members(int32_t node) const;
    /// Mean length of a node's pieces: B_w of S1.
    double mean_frames(int32_t node) const;

    /// Nodes that a node's edges lead to, ascending; itself, where it follows itself.
    std::span<const int32_t> targets(int32_t node) const;
    /// What the edge to targets(node)[edge] stands for, by ascending piece.
    std::span<const Succession> successions(int32_t node, int64_t edge) const;
    /// Those of all edges of a node, by target.
    std::span<const Succession> successions(int32_t node) const;
    /// Frames between the two, in their clip.
    int64_t gap(const Succession& succession) const;

    /// Links nodes, instead of those linked before; one pair may be named several times. Throws
    /// std::invalid_argument for a node that is not there, or linked with itself.
    void link(std::span<const NodeLink> links);
    /// Each pair once, the lower node first, ascending.
    std::vector<NodeLink> links() const;
    /// Nodes linked with a node, ascending.
    std::span<const int32_t> linked(int32_t node) const;
    /// Those nodes and those linked with them, ascending.
    std::vector<int32_t> with_linked(std::span<const int32_t> nodes) const;
    /// How a node may be left: by its own successions, then by those of the nodes linked with it.
    std::vector<Succession> ways_on(int32_t node) const;
    /// Nodes that these lead to, ascending.
    std::vector<int32_t> next_nodes(int32_t node) const;

  private:
    std::vector<MotionPiece> pieces_;
    std::vector<int32_t> node_of_;
    std::vector<int32_t> members_;                 ///< by node
    std::vector<int64_t> members_of_{0};           ///< nodes + 1, into members_
    std::vector<int32_t> targets_;                 ///< by node
    std::vector<int64_t> edges_of_{0};             ///< nodes + 1, into targets_
    std::vector<Succession> successions_;          ///< by edge
    std::vector<int64_t> successions_of_edge_{0};  ///< edges + 1, into successions_
    std::vector<int32_t> linked_;                  ///< by node
    std::vector<int64_t> links_of_;                ///< nodes + 1, into linked_
};

// What leads where is said of next_nodes here: a linked node's edges are a node's, too.

/// Largest sets of nodes that all lead to one another, numbered by their lowest node.
struct StrongComponents {
    std::vector<int32_t> component_of;        ///< by node
    std::vector<std::vector<int32_t>> nodes;  ///< by component, ascending
    std::vector<bool> cyclic;                 ///< whether a walk can stay in it for ever
};
StrongComponents strong_components(const MotionGraph& graph);

/// Which nodes lead to one of `targets`, these themselves among them. By node.
std::vector<bool> nodes_that_reach(const MotionGraph& graph, std::span<const int32_t> targets);
/// Which nodes are led to from one of `sources`, these themselves among them. By node.
std::vector<bool> nodes_reached(const MotionGraph& graph, std::span<const int32_t> sources);

/// The nodes of a path with fewest edges from one of `sources` to one of `targets`, both ends
/// included; of equal ones that whose nodes come first. Empty when there is none.
std::vector<int32_t> shortest_path(const MotionGraph& graph, std::span<const int32_t> sources,
                                   std::span<const int32_t> targets);

}  // namespace kinetome
