// The clips that a walk plays, on one body and at one rate, and how it goes over between them.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/graph_walk.h"
#include "kinetome/models/motion_blend.h"
#include "kinetome/models/motion_quality.h"
#include "kinetome/stages/primitive_walk.h"

namespace kinetome {

/// Read and measured when they are first asked for. Keeps references to graph, source and options.
class WalkClips {
  public:
    /// Throws UsageError for a body of another class.
    WalkClips(const StoredGraph& graph, const ClipSource& source, const WalkOptions& options,
              const std::string& body);

    const std::string& body() const { return body_; }
    /// By number in the graph; those not yet asked for have no frames.
    const std::vector<Clip>& clips() const { return clips_; }
    const ClipSupports& supports() const { return supports_; }

    /// What the walk plays (runs_of_walk).
    std::vector<MotionRun> runs(const GraphWalk& walk);
    /// A piece as a part of a blend, registered to another one unless the options are against it.
    BlendPart part(int32_t piece, int32_t registered_to, double weight);
    /// By what share of it going over from the one to the other exceeds what their clips do: how
    /// fast a pose changes in the pieces of both, how fast a joint moves, how hard it is thrown.
    double excess(int32_t entry, int32_t exit);
    /// Where a walk's motion exceeds what its clips do, going over has an excess from now on: what
    /// is in order alone need not be where one follows the other at once. What had one already, and
    /// was walked for want of another way, lasts longer from now on. False when neither is so.
    bool mend(const GraphWalk& walk, const std::vector<MotionRun>& runs, const Clip& motion);

  private:
    /// The largest of a motion, or of a frame.
    struct Peaks {
        double pose_step = 0;
        JointPeaks joints;

        Peaks& operator|=(const Peaks& other);
        /// By what share of it one of them is above its bound; negative below.
        double excess(const Peaks& bound) const;
    };
    static std::vector<Peaks> peaks_by_frame(const Clip& clip, const MatrixFView& positions);
    Peaks measured_peaks(int32_t clip, const MatrixFView& positions) const;
    const Clip& clip(int32_t number);
    const Crossing& crossing(int32_t entry, int32_t exit);
    /// Where fades of these lengths pass best from the one piece to the other.
    Crossing crossing(int32_t entry, int32_t exit, const Crossing& fade);
    double fade_frames() const { return options_.fade_seconds * graph_.rate; }

    const StoredGraph& graph_;
    const ClipSource& source_;
    const WalkOptions& options_;
    std::string body_;
    std::shared_ptr<const Skeleton> skeleton_;
    std::vector<Clip> clips_;
    ClipSupports supports_;
    std::vector<Peaks> peaks_;  ///< of each clip: pose steps in its pieces, joints in all of it
    std::map<std::pair<int32_t, int32_t>, Crossing> crossings_;
    std::map<std::pair<int32_t, int32_t>, double> excesses_;
};

}  // namespace kinetome
