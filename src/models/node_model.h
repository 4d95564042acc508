// The local linear model of one node, from the moments of its poses.
#pragma once

#include <vector>

#include "kinetome/math/moments.h"
#include "kinetome/models/hierarchy_growth.h"

namespace kinetome {

struct FittedNode {
    NodeModel model;       ///< with a basis when it may be a leaf
    VectorD spread_along;  ///< p, unit length: where the principal values vary most; none when it
                           ///< need not be split, or cannot be because they all coincide

    bool may_be_leaf() const { return model.basis.size() > 0; }
    bool can_split() const { return spread_along.size() > 0; }
};

void pack(Packer& out, const FittedNode& node);
void unpack(Unpacker& in, FittedNode& node);

/// `parent`: null at the root.
FittedNode fit_node(const Moments& poses, const std::vector<int32_t>& principal_columns,
                    const MarkerMap* parent, const PoseHierarchyOptions& options);

}  // namespace kinetome
