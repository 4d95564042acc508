// Random walks through a motion graph, and the runs of clips they play (S1 §4, S3 §6.2).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/motion_graph.h"
#include "kinetome/models/motion_walk.h"

namespace kinetome {

struct WalkRequest {
    double frames = 0;               ///< wanted length, at the rate of the graph's pieces
    uint64_t seed = 1;               ///< the same seed walks the same way
    std::vector<int32_t> from = {};  ///< nodes of which one begins; empty: any
    std::vector<int32_t> to = {};    ///< nodes of which one ends; empty: any
    /// How far going over from a piece to another of its node is beyond what is wanted; 0 or less:
    /// it is not. Empty: never.
    std::function<double(int32_t entry, int32_t exit)> excess = {};
};

/// A node is entered by one of its pieces and left by another, by the same, or by one of a node
/// that is linked with it.
struct WalkStep {
    int32_t node = 0;
    int32_t entry = 0, exit = 0;  ///< pieces; equal in the last step, unless the walk ends in a
                                  ///< node that is linked with a wanted one, and goes over
    bool operator==(const WalkStep&) const = default;
};

struct GraphWalk {
    std::vector<WalkStep> steps;
    double frames = 0;  ///< what its runs last if it goes over in the middle of pieces
    /// Nothing (that leads to a wanted end) followed the last node, and `frames` falls short.
    bool ended_early = false;
};

/// Goes from node to node as the takes do: each succession out of a node, or out of one linked with
/// it, is as likely as any other.
/// Those with an excess are not taken; where a walk could go on, or reach `to`, with excess only,
/// it goes back and takes another way. What excess is left is in graphs without another way. It
/// keeps to nodes from which one of `to` can be reached, and does not get stuck while there is a
/// way out: it leads to the cycle of nodes with most pieces among those within reach, and stays.
/// From the moment when the shortest way to `to` fills the wanted length it takes a short way
/// there; so with `to` the walk ends with a whole piece, else with the first piece that fills the
/// length. No steps when no node of `from` leads to one of `to`. Throws std::invalid_argument for
/// nodes that are not there.
GraphWalk random_walk(const MotionGraph& graph, const WalkRequest& request);

/// Where a walk goes over from a piece to another of the same node: frames after their firsts, at
/// the middle of the fade, need not be whole.
struct Crossing {
    double entry = 0, exit = 0;
    std::vector<double> registration = {};  ///< MotionRun::registration of the fade
    double slowness = 1;                    ///< how many natural_fade_frames it lasts, 1 or more
};

/// Where the pieces agree best: of all moments that dynamic time warping finds to answer each other
/// (slope_limited_steps, warp.h), those about which the poses are nearest over the length of the
/// fade. `entry` and `exit` are the n × d and m × d poses of the pieces, place and heading removed;
/// lengths and result count in rows. The fade stays inside both pieces, `fade_entry` and
/// `fade_exit` rows of them; the middles of both when that leaves no choice or no warp is found.
/// The fade is registered by the same warp, made smooth; not at all where there is none.
Crossing best_crossing(const MatrixFView& entry, const MatrixFView& exit, double fade_entry,
                       double fade_exit);

/// Lengths of a fade on both its sides: in the proportion of the pieces' lengths, so that it goes
/// through equal shares of them, `fade_frames` in the mean but no longer than the pieces.
Crossing fade_lengths(const MotionPiece& entry, const MotionPiece& exit, double fade_frames);

/// What the walk plays: inside a node it goes over from the entry to the exit where
/// `crossing(entry, exit)` says, moved as far as the fade (fade_lengths) needs to stay inside the
/// pieces; from node to node it goes on in the clip of the exit, with the frames that lie between.
/// So every seam is one that a take has. Fades begin and end at whole frames and last whole ones:
/// between them the frames of the takes are played, and a crossing is the same in every walk.
std::vector<MotionRun> runs_of_walk(
    const MotionGraph& graph, const std::vector<WalkStep>& steps, double fade_frames,
    const std::function<Crossing(int32_t entry, int32_t exit)>& crossing);
/// The same, in the middle of both.
std::vector<MotionRun> runs_of_walk(const MotionGraph& graph, const std::vector<WalkStep>& steps,
                                    double fade_frames);

}  // namespace kinetome
