// What no performer holds still, and what no camera sees exactly.
#pragma once

#include <span>
#include <vector>

#include "kinetome/base/random.h"
#include "kinetome/formats/skeleton.h"
#include "kinetome/synthesis/drift.h"
#include "kinetome/synthesis/posture.h"

namespace kinetome {

/// Slow independent drifts of the controls that may drift.
class PostureWandering {
  public:
    explicit PostureWandering(RandomStream& random);
    PostureWandering(const PostureWandering&) = delete;  // tracks point into it
    PostureWandering& operator=(const PostureWandering&) = delete;
    /// Moves on by one frame.
    void add_to(Posture& posture, RandomStream& random);

  private:
    struct Track {
        double* value;  ///< in step_
        Drift drift;
    };
    template <class Key>
    void add_tracks(ValueTable<Key>& step, const ValueTable<Key>& spread, RandomStream& random);

    Posture step_;
    std::vector<Track> tracks_;
};

/// Joints bend in ways the controls do not name, and a capture system adds its own noise, most of
/// it smooth after filtering.
class JointNoise {
  public:
    JointNoise(const Skeleton& skeleton, RandomStream& random);
    /// Moves on by one frame.
    void add_to(std::span<double> dofs, RandomStream& random);

  private:
    struct Track {
        Drift slow, fast;
        double white;  ///< standard deviation
    };
    std::vector<Track> tracks_;
};

}  // namespace kinetome
