// Segments made without looking at the motion: what a score is worth shows beside what these reach.
#pragma once

#include <cstdint>
#include <vector>

#include "kinetome/base/random.h"
#include "kinetome/models/segment.h"
#include "kinetome/models/truth_timeline.h"

namespace kinetome {

/// Activities of `length` frames each (the last may be shorter), each a cluster of its own.
/// length > 0.
std::vector<Segment> cuts_every(int64_t frames, int64_t length);

/// `count` activities of equal length as far as whole frames allow, each a cluster of its own.
/// 1 ≤ count ≤ frames.
std::vector<Segment> uniform_cuts(int64_t frames, int64_t count);

/// `count` activities between cuts drawn without replacement, each a cluster of its own.
/// 1 ≤ count ≤ frames.
std::vector<Segment> random_cuts(int64_t frames, int64_t count, RandomStream& random);

/// The annotated activities, clustered by class, without transitions.
std::vector<Segment> segments_of(const TruthTimeline& truth);

}  // namespace kinetome
