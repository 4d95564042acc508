// A hierarchy while it grows: its planes so far, and where in it every pose is.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/math/row_source.h"
#include "kinetome/models/hierarchy_growth.h"

namespace kinetome {

/// The planes of the levels that are finished.
class GrowingTree {
  public:
    /// overlap: of planes that overlap, in half gaps.
    GrowingTree(int64_t principal_columns, double overlap)
        : columns_(principal_columns), overlap_(overlap) {}

    void add(const HierarchyLevel& level);

    /// Whether poses at a node pass on to its children.
    bool is_split(int32_t node) const {
        return static_cast<size_t>(node) < nodes_.size() && nodes_[static_cast<size_t>(node)].below;
    }
    int32_t below(int32_t node) const { return nodes_[static_cast<size_t>(node)].below; }
    /// normal · s - offset.
    double distance_above(int32_t node, const double* principal) const;
    /// Distance from the plane up to which poses belong to both sides.
    double band(int32_t node) const { return nodes_[static_cast<size_t>(node)].band; }
    /// Number of the first node of the level that grows.
    int32_t first_open() const { return static_cast<int32_t>(nodes_.size()); }

  private:
    struct Node {
        int32_t below = 0;  ///< 0: not split; the child above comes after it
        double offset = 0;
        double band = 0;
    };

    int64_t columns_;
    double overlap_;
    std::vector<Node> nodes_;
    std::vector<double> normals_;  ///< nodes × p
};

/// Where a pose, or a copy of it, is.
struct PosePlace {
    int32_t node = 0;
    uint16_t row = 0;  ///< in its piece
    bool is_copy = false;
};

/// The places of all poses, piece by piece; they move down when they are asked for.
class PosePlaces {
  public:
    /// Refers to both.
    PosePlaces(const RowSource& principal, const GrowingTree& tree);

    /// Those of a piece in the tree as it is, rows ascending. One thread a piece at a time.
    std::span<const PosePlace> of(const RowRange& piece) const;

  private:
    bool can_move(const std::vector<PosePlace>& places) const;
    void move_down(const PosePlace& from, const double* principal,
                   std::vector<PosePlace>& to) const;

    const RowSource& principal_;
    const GrowingTree& tree_;
    mutable std::vector<std::vector<PosePlace>> places_;  ///< one a piece; empty: not yet asked for
};

/// Poses of one node in a piece.
struct NodeRows {
    int32_t slot = 0;           ///< of the node in the list that a pass is about
    std::vector<int32_t> rows;  ///< in the piece, ascending
};

/// Those of the nodes of interest: slots[node - first] is a node's slot, -1 where it is none.
std::vector<NodeRows> rows_by_node(std::span<const PosePlace> places, int32_t first,
                                   const std::vector<int32_t>& slots);

}  // namespace kinetome
