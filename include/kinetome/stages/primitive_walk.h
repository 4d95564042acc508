// Walks through the primitives of a store (S3 §6.2), or through its motion bundles (S1 §4).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinetome/models/motion_quality.h"
#include "kinetome/stages/stored_graph.h"

namespace kinetome {

struct WalkOptions {
    double seconds = 30;        ///< wanted length
    uint64_t seed = 1;          ///< the same seed walks the same way
    std::string from = {};      ///< label or cluster of the first primitive; "": any
    std::string to = {};        ///< of the last one; "": any
    double fade_seconds = 0.4;  ///< that going over from one primitive to another takes at most
    bool registered = true;     ///< going over, what dynamic time warping finds alike is blended
    double longest_gap = 2;     ///< seconds between two primitives of which one follows the other
    std::string body = {};      ///< clip whose skeleton moves; "": the first clip of the walk
    GraphStyle style = {};      ///< how the graph's pieces are called
};

struct PrimitiveWalk {
    Clip motion;
    std::string body;                      ///< clip whose skeleton it is
    std::vector<ClipPrimitive> path = {};  ///< one a step: the primitive that enters its node
    std::vector<std::string> nodes = {};   ///< one a step, two where it goes over into a linked one
    WalkQuality quality = {};
    bool ended_early = false;  ///< nothing follows the last primitive that leads to a wanted end
};

/// Through the primitives of one class of skeletons: that of most of those that `from` names, or of
/// most. Linked clusters are left by each other's primitives, so that the motion of one body leads
/// to that of another. Clips of other bodies are put on the one that moves (retarget.h), clips of
/// other rates are resampled. It goes over from one primitive of a node to another where they agree
/// best (best_crossing), feet held where they stand (MotionBlend), and only where no pose changes
/// faster than in pieces of the two clips, as long as there is such a way on. Without `to` the
/// motion is cut to the wanted length. Throws UsageError for options that make no sense, for a
/// label or cluster that is not there, and when no path leads from the one to the other.
PrimitiveWalk walk_primitives(const std::vector<ClipPrimitive>& primitives,
                              const ClipSource& source, const WalkOptions& options,
                              const std::vector<ClusterLink>& links = {});

}  // namespace kinetome
