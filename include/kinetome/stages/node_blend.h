// The motions of one bundle or cluster of primitives blended with given weights: the blend spaces
// that S1 §6 names as a use.
#pragma once

#include <string>
#include <vector>

#include "kinetome/models/motion_quality.h"
#include "kinetome/stages/stored_graph.h"

namespace kinetome {

struct BlendOptions {
    std::string node;                  ///< label or number of a bundle or cluster
    std::vector<double> weights = {};  ///< of its motions, in order; none: all alike
    bool registered =
        true;               ///< what dynamic time warping finds alike is blended; else equal shares
    std::string body = {};  ///< clip whose skeleton moves; "": that of the heaviest motion
    GraphStyle style = {};  ///< how the graph's pieces are called
};

struct NodeBlend {
    Clip motion;
    std::string body;                  ///< clip whose skeleton it is
    std::string node;                  ///< its name
    std::vector<ClipPrimitive> parts;  ///< all motions of the node, by clip and frame
    std::vector<double> weights;       ///< theirs, which add up to 1
    JointPeaks peaks, peaks_of_parts;
    double pose_step = 0, pose_step_of_parts = 0;  ///< the largest, cm/s
};

/// The motions of the one bundle or cluster (style.group) that has the label or number. Throws
/// UsageError, naming the command's option, when there is none or several.
std::vector<ClipPrimitive> motions_of_node(const std::vector<ClipPrimitive>& primitives,
                                           const std::string& name, const GraphStyle& style,
                                           const std::string& option);

/// All motions of a node at once from beginning to end (blend_motions), registered to the heaviest
/// one. Clips of other bodies are put on the one that moves, clips of other rates are resampled.
/// Throws UsageError for a name that no node or several nodes have, for weights that are negative,
/// all zero or not as many as there are motions.
NodeBlend blend_node(const std::vector<ClipPrimitive>& primitives, const ClipSource& source,
                     const BlendOptions& options);

}  // namespace kinetome
