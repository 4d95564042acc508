// How the memory granted is shared out while a pose hierarchy grows, and how large it will be.
#pragma once

#include <cstdint>

#include "kinetome/base/resources.h"
#include "kinetome/models/hierarchy_growth.h"

namespace kinetome {

/// Poses that a hierarchy is made of.
struct HierarchySize {
    int64_t rows = 0;
    int64_t columns = 0;    ///< f
    int64_t principal = 0;  ///< p
    double seconds = 0;     ///< of motion that the rows are poses of
};

struct HierarchyMemory {
    int64_t nodes_per_pass = 1;
    uint64_t principal_bytes = 0;  ///< of principal columns that stay in memory
    uint64_t pose_bytes = 0;       ///< of whole poses that do
};

/// Leaves as long as nothing is grown: of real motion, fewer for a wider tolerance and a higher
/// dimension.
int64_t expected_leaves(const HierarchySize& size, const PoseHierarchyOptions& options);

/// Bytes of a leaf: mean, basis, map and plane.
uint64_t leaf_bytes(const HierarchySize& size, const PoseHierarchyOptions& options);

/// Bytes that growth is expected to take at each rank beside sums and rows that are kept: where
/// every pose is, and the model.
uint64_t growth_bytes(const HierarchySize& size, const PoseHierarchyOptions& options);

/// First the model that is expected, then sums of a pass, principal columns and poses. Throws
/// UsageError when not even the places of all poses and the smallest pass fit into the memory
/// granted.
HierarchyMemory share_memory(const HierarchySize& size, const PoseHierarchyOptions& options,
                             const Resources& resources, int ranks);

}  // namespace kinetome
