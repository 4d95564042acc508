// One level of a growing hierarchy: what its nodes are like, which of them are leaves, and the
// planes that part the others.
#pragma once

#include <cstdint>
#include <vector>

#include "growing_tree.h"
#include "kinetome/base/communicator.h"
#include "kinetome/base/stop.h"
#include "kinetome/math/row_source.h"
#include "kinetome/models/hierarchy_growth.h"
#include "node_model.h"

namespace kinetome {

/// What every pass over the poses needs.
struct GrowthPass {
    const RowSource& poses;
    const RowSource& principal;
    const std::vector<int32_t>& principal_columns;
    const PoseHierarchyOptions& options;
    const Workers& workers;
    const GrowingTree& tree;
    const PosePlaces& places;
    const StopToken& stop;
};

/// The models of the open nodes, whose parents are given in the same order (null: the root), from
/// passes of statistics about `nodes_per_pass` nodes each. The same at every rank.
std::vector<FittedNode> fit_nodes(const GrowthPass& pass,
                                  const std::vector<const NodeModel*>& parents,
                                  int64_t nodes_per_pass);

/// Takes the basis from nodes that may be leaves but, by the largest error of any of their poses,
/// are not.
void refuse_poses_beyond(const GrowthPass& pass, std::vector<FittedNode>& nodes);

/// The planes of the nodes that are no leaves, by 2-means on their principal values; none for
/// leaves.
std::vector<std::optional<SplitPlane>> split_nodes(const GrowthPass& pass,
                                                   const std::vector<FittedNode>& nodes);

}  // namespace kinetome
