// How much of a collection repeats itself (S3 §1): poses that come back after the body has been
// elsewhere.
#pragma once

#include <cstdint>
#include <vector>

#include "kinetome/base/matrix.h"

namespace kinetome {

/// Times are seconds, distances those of the features (cm).
struct PoseRecurrenceOptions {
    double rate = 30;                     ///< of the features, frames a second
    double radius = 64;                   ///< poses no farther apart than this are the same one
    double shortest_take = 8;             ///< takes that are no longer are not asked
    double longest_return = 10;           ///< a pose that comes back later does not count
    double least_intermission = 1.0 / 3;  ///< in between, so long without a break, poses differ
};

/// Sums over takes. S3 says "81.89 % of all motion sequences" and not how it counts; both shares
/// can be had.
struct PoseRecurrence {
    int64_t takes = 0;             ///< longer than the shortest
    int64_t recurring_takes = 0;   ///< of them, those with a pose that comes back
    int64_t frames = 0;            ///< of them all
    int64_t recurring_frames = 0;  ///< whose pose comes back, or came before
    PoseRecurrence& operator+=(const PoseRecurrence& other);
    bool operator==(const PoseRecurrence&) const = default;
};

/// One a row of the n × d features of a take (S3 §3: 45 columns at 30 Hz): whether the pose comes
/// back in time, or came before.
std::vector<char> recurring_frames(const MatrixFView& features,
                                   const PoseRecurrenceOptions& options = {});

/// The part of one take.
PoseRecurrence pose_recurrence(const MatrixFView& features,
                               const PoseRecurrenceOptions& options = {});

}  // namespace kinetome
