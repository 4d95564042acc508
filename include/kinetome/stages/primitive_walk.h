// Walks through the primitives of a store (S3 §6.2).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "kinetome/formats/clip.h"
#include "kinetome/models/motion_quality.h"
#include "kinetome/models/primitive_graph.h"

namespace kinetome {

/// A primitive as a walk needs it; frames at the source's rate, end exclusive.
struct ClipPrimitive {
    std::string clip;
    int64_t first = 0, end = 0;
    int32_t cluster = -1;    ///< -1: like no other
    std::string label = {};  ///< "": not known

    bool operator==(const ClipPrimitive&) const = default;
};

/// What is known of a clip before it is read.
struct ClipKind {
    std::string clip_class;  ///< of its skeleton
    double rate = 120;       ///< frames a second
};

/// Where clips come from; both throw when there is no clip of that name.
struct ClipSource {
    std::function<ClipKind(const std::string& clip)> kind;
    std::function<Clip(const std::string& clip)> read;
};

struct WalkOptions {
    double seconds = 30;        ///< wanted length
    uint64_t seed = 1;          ///< the same seed walks the same way
    std::string from = {};      ///< label or cluster of the first primitive; "": any
    std::string to = {};        ///< of the last one; "": any
    double fade_seconds = 0.4;  ///< that going over from one primitive to another takes at most
    double longest_gap = 2;     ///< seconds between two primitives of which one follows the other
    std::string body = {};      ///< clip whose skeleton moves; "": the first clip of the walk
};

/// The graph of the primitives of one class of skeletons at one rate: those of `from`, where it is
/// given, else those that most primitives have.
struct ClassGraph {
    PrimitiveGraph primitives;
    std::vector<ClipPrimitive> pieces;  ///< of its graph's pieces, at their sources' rates
    std::vector<std::string> clips;     ///< by number in the graph
    std::string clip_class;
    double rate = 0;  ///< frames a second of the graph's pieces
};

/// Throws UsageError when there are no primitives, or none that `from` names.
ClassGraph class_graph(const std::vector<ClipPrimitive>& primitives, const ClipSource& source,
                       const WalkOptions& options);

struct PrimitiveWalk {
    Clip motion;
    std::string body;                      ///< clip whose skeleton it is
    std::vector<ClipPrimitive> path = {};  ///< one a step: the primitive that enters its node
    std::vector<std::string> nodes = {};   ///< one a step
    WalkQuality quality = {};
    bool ended_early = false;  ///< nothing follows the last primitive that leads to a wanted end
};

/// Clips of other bodies are put on the one that moves (retarget.h), clips of other rates are
/// resampled. Without `to` the motion is cut to the wanted length. Throws UsageError for options
/// that make no sense, for a label or cluster that is not there, and when no path leads from the
/// one to the other.
PrimitiveWalk walk_primitives(const ClassGraph& graph, const ClipSource& source,
                              const WalkOptions& options);

}  // namespace kinetome
