// Other takes made from a take: as in a mirror, by a larger or smaller body, at another pace.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinetome/base/random.h"
#include "kinetome/formats/clip.h"
#include "kinetome/formats/skeleton.h"

namespace kinetome {

/// The body seen in a mirror (the plane x = 0 of its rest pose): each joint takes the shape of its
/// partner on the other side (lfemur that of rfemur), reflected. Names, parents, channels and their
/// order stay, so its class does too. Throws std::invalid_argument when a left joint and its
/// partner differ in parents or channels.
Skeleton mirrored(const Skeleton& skeleton);

/// The motion seen in the mirror, on the mirrored skeleton: every joint's position is the
/// reflection in x = 0 of its partner's. Exact for any skeleton, even one with uneven sides.
Clip mirrored(const Clip& clip);

/// "punch_left" → "punch_right"; names without a side stay.
std::string mirrored_label(std::string_view label);

/// All lengths times `factor`: bones, and the way the root travels.
Skeleton scaled(const Skeleton& skeleton, double factor);
Clip scaled(const Clip& clip, double factor);

/// A change of pace: where in the source each frame of the new take lies. The speed wanders
/// smoothly within [0.7, 1.4].
class TimeWarp {
  public:
    TimeWarp(int64_t source_frames, RandomStream& random);

    int64_t frames() const { return static_cast<int64_t>(source_frames_.size()); }
    /// Drops what comes after `frames`.
    void cut(int64_t frames);
    const std::vector<double>& source_frames() const { return source_frames_; }
    /// The first frame of the new take at or after a frame of the source; frames() when there is
    /// none. Maps boundaries of frame ranges, end exclusive.
    int64_t frame_at(int64_t source_frame) const;

  private:
    std::vector<double> source_frames_;  ///< increasing, from 0
};

}  // namespace kinetome
