// How well motion bundles keep apart what annotations call by different names.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/models/motion_graph.h"

namespace kinetome {

/// Class of each frame of a clip; unlabelled frames have none.
using FrameClasses = std::vector<int32_t>;
inline constexpr int32_t no_class = -1;

/// Of bundles with several members in clips that are labelled.
struct BundleScore {
    double purity = 0;    ///< share of their labelled frames that have their bundle's main class
    double shuffled = 0;  ///< the same with members dealt out to the bundles at random
    double chance = 0;    ///< share that the main class of all frames has
    double coverage = 0;  ///< share of the clips' frames that is in them
    int64_t bundles = 0;
    double mean_height = 0;   ///< members a bundle
    double median_width = 0;  ///< of the bundles' mean lengths, frames
};

/// `members` are those of bundles that have several, `bundle_of` names the bundle of each;
/// `classes` one list a clip, at the rate of the members, empty for clips without labels. What lies
/// in those is not counted. Throws std::invalid_argument when the shapes disagree.
BundleScore score_bundles(std::span<const MotionPiece> members, std::span<const int32_t> bundle_of,
                          std::span<const FrameClasses> classes, uint64_t seed = 1);

}  // namespace kinetome
