// Divisive clustering of poses into a hierarchy of local linear models (S2 §4), level by level: one
// pass of statistics for all nodes of a level, then 2-means on the principal markers for all that
// must be split.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/matrix.h"
#include "kinetome/base/packing.h"
#include "kinetome/base/stop.h"
#include "kinetome/math/row_source.h"
#include "kinetome/models/marker_maps.h"
#include "kinetome/models/pose_hierarchy.h"

namespace kinetome {

enum class LeafRule {
    rms,     ///< the RMS over a leaf's poses is within the tolerance
    maximum  ///< every pose of a leaf is
};

struct PoseHierarchyOptions {
    int dimension = 4;                   ///< d, of the leaves' linear models
    double leaf_tolerance = 20;          ///< mm per marker
    LeafRule leaf_rule = LeafRule::rms;  ///< what must be within the tolerance
    /// Poses within so many half gaps of a plane belong to both sides (S2: fuzzy partition); copies
    /// are not copied again. 0: every pose belongs to one leaf.
    double overlap = 0;
    double largest_share =
        0.9;                    ///< a node is split without overlap if a child would get more of it
    int split_iterations = 15;  ///< of 2-means at most
    MarkerMapOptions maps;
};

/// The plane that parts a node: the middle between the centroids of its halves.
struct SplitPlane {
    VectorD normal;       ///< p, unit length
    double offset = 0;    ///< normal · s = offset
    double half_gap = 0;  ///< cm
    bool overlaps = false;
};

/// A node's linear model, and what its children need of it.
struct NodeModel {
    int64_t rows = 0;
    VectorD mean;      ///< f, cm
    double error = 0;  ///< of a leaf, mm per marker: RMS that d dimensions leave
    MatrixD basis;     ///< of a leaf, f × d
    MarkerMap map;
};

struct GrownNode {
    NodeModel model;
    std::optional<SplitPlane> split;  ///< none: a leaf
};

/// Nodes of one depth, in node order. The children of those that are split are the next level.
using HierarchyLevel = std::vector<GrownNode>;

void pack(Packer& out, const NodeModel& model);
void unpack(Unpacker& in, NodeModel& model);
void pack(Packer& out, const HierarchyLevel& level);
void unpack(Unpacker& in, HierarchyLevel& level);

struct GrownHierarchy {
    PoseHierarchy hierarchy;
    MarkerMaps maps;
};

void pack(Packer& out, const GrownHierarchy& grown);
void unpack(Unpacker& in, GrownHierarchy& grown);

/// What a run keeps of its growth: levels as they are finished, to go on from.
struct GrowthCheckpoints {
    std::function<void(int level, const HierarchyLevel&)> save = [](int, const HierarchyLevel&) {};
    /// The level of an earlier run; nothing when it did not come so far.
    std::function<std::optional<HierarchyLevel>(int level)> load = [](int) { return std::nullopt; };
};

/// Bytes of sums that a pass holds at once for each node it is about, at each rank.
uint64_t pass_bytes_per_node(int64_t columns, int threads);

/// Grows a hierarchy from poses (n × f, cm) whose principal columns (ascending) are `principal`
/// (n × p), read apart because 2-means passes over them many times. `nodes_per_pass`: most nodes
/// that one pass of statistics is about. The result is the same for any of those, for threads and
/// for ranks. Throws std::invalid_argument without poses and for a value that is not finite, naming
/// its row and column; Interrupted between passes.
GrownHierarchy grow_pose_hierarchy(const RowSource& poses, const RowSource& principal,
                                   const std::vector<int32_t>& principal_columns,
                                   const PoseHierarchyOptions& options, const Workers& workers,
                                   int64_t nodes_per_pass, const StopToken& stop = {},
                                   const GrowthCheckpoints& checkpoints = {});

}  // namespace kinetome
