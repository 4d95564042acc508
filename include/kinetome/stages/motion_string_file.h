// motion_strings.h5, read by those who search in strings.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinetome/models/motion_string.h"
#include "kinetome/models/pose_clusters.h"
#include "kinetome/store/artifact.h"

namespace kinetome {

/// A clip of a partition; its letters count frames at the pose rate.
struct SpelledClip {
    std::string name;
    int64_t frames = 0;  ///< at the pose rate
    int64_t source_frames = 0;
    double source_rate = 0;
};

/// A partition's string. Clips have the numbers that the string names.
struct StoredMotionString {
    std::vector<SpelledClip> clips;
    MotionString string;
    AccessibilityMatrix accessibility;
    double tau = 0;
    int64_t lambda = 0;
    double pose_rate = 0;
};

/// Paths of the partitions in the file, in its order.
std::vector<std::string> spelled_partitions(const ArtifactReader& file);
/// Throws StoreError when the file does not hold that partition.
StoredMotionString read_motion_string(const ArtifactReader& file, const std::string& partition);

}  // namespace kinetome
