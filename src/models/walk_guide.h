// Where a walk through a motion graph may go, and where it should.
#pragma once

#include <cstdint>
#include <vector>

#include "kinetome/models/graph_walk.h"

namespace kinetome {

/// What it takes from the seam where `entry` begins to the one where what follows `exit` does.
double frames_of_step(const MotionGraph& graph, int32_t entry, const Succession& exit);

/// Keeps a reference to the graph.
class WalkGuide {
  public:
    WalkGuide(const MotionGraph& graph, const WalkRequest& request);

    /// Nodes that a walk may begin in.
    const std::vector<int32_t>& starts() const { return starts_; }
    /// Whether a walk may end in a node: linked ones are as good as those that are wanted.
    bool is_goal(int32_t node) const;
    /// Frames from entering a node to the end of the nearest goal, by the mean length of pieces.
    double frames_to_goal(int32_t node) const { return to_goal_[static_cast<size_t>(node)]; }
    /// Successions to nodes from which a goal can be reached.
    std::vector<Succession> ways_to_goal(int32_t node) const;
    /// Of these, those to nodes from which the walk can go on for ever, if there are such.
    std::vector<Succession> ways_on(int32_t node) const;

  private:
    bool allowed(int32_t node) const { return allowed_[static_cast<size_t>(node)]; }
    bool lasting(int32_t node) const { return lasting_[static_cast<size_t>(node)]; }
    /// The nodes of the cycle with most pieces within reach; empty when there is none.
    std::vector<int32_t> largest_cycle(const std::vector<int32_t>& starts) const;
    double mean_frames(int32_t node) const;
    /// Dijkstra, against the edges.
    std::vector<double> frames_to(const std::vector<int32_t>& goals) const;

    const MotionGraph& graph_;
    std::vector<int32_t> goals_;  ///< ascending
    std::vector<bool> allowed_, lasting_;
    std::vector<double> to_goal_;
    std::vector<int32_t> starts_;
};

}  // namespace kinetome
