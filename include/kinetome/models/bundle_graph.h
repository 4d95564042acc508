// The motion graph of bundles (S1 §4): bundles are its nodes, what lies between them its edges.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/models/motion_bundle.h"
#include "kinetome/models/motion_graph.h"

namespace kinetome {

/// A member of a bundle in frames of its clip.
struct BundleMember {
    int32_t bundle = 0;
    MotionPiece frames;
    bool operator==(const BundleMember&) const = default;
};

/// Members of all bundles, by clip and frame: bundle b is bundles[b]. `frames` holds f(j) by letter
/// (BundleEnds). Throws std::invalid_argument when there are not as many as letters.
std::vector<BundleMember> bundle_members(const MotionString& string,
                                         std::span<const SubstringBundle> bundles,
                                         std::span<const int32_t> frames);

/// Where the frames of the clips are.
struct BundleGraphFrames {
    int64_t in_nodes = 0;
    int64_t in_edges = 0;  ///< of transitions, the alternatives of each edge included
    int64_t dangling = 0;  ///< before the first and after the last node of a clip

    int64_t sum() const { return in_nodes + in_edges + dangling; }
};

struct BundleGraph {
    /// Pieces: members of bundles that have several. A degenerate bundle between two nodes is the
    /// gap between a piece and the next one.
    MotionGraph graph;
    BundleGraphFrames frames;
};

/// `node_of` names the node of each bundle, in [0, nodes), or is below 0 for a degenerate one;
/// `clip_frames` the lengths of the clips. A degenerate bundle that no node comes before or after
/// has no place in the graph: its frames dangle. Throws what MotionGraph throws, and
/// std::invalid_argument for a bundle or a clip that is not there.
BundleGraph bundle_graph(std::span<const BundleMember> members, std::span<const int32_t> node_of,
                         int32_t nodes, std::span<const int64_t> clip_frames);

}  // namespace kinetome
