// Motion bundles (S1 §3.3): a motion string cut into substrings, similar ones together.
#pragma once

#include <cstdint>
#include <vector>

#include "kinetome/models/bundle_options.h"
#include "kinetome/models/motion_string.h"
#include "kinetome/models/pose_clusters.h"
#include "kinetome/models/reach_tables.h"
#include "kinetome/models/substring.h"

namespace kinetome {

/// Members share no interval; ascending. A bundle of one member is degenerate.
struct SubstringBundle {
    std::vector<Substring> members;

    int64_t height() const { return static_cast<int64_t>(members.size()); }
    bool is_degenerate() const { return members.size() == 1; }
    bool operator==(const SubstringBundle&) const = default;
};

/// Longest substring that can be matched, in letters.
inline constexpr int64_t most_matched_letters = 512;

/// Bundles that hold each interval of each clip once: first those with several members, in the
/// order in which they were found, then the degenerate ones, adjacent ones merged, in the order of
/// the string. `longest` is λ (longest_substring); members have up to 2 λ letters, at most
/// most_matched_letters. `accessibility` is that of accessibility_for_bundles.
/// Results depend on `resources` in no way. Throws std::invalid_argument for options out of range
/// and letters that the matrix does not have.
std::vector<SubstringBundle> find_motion_bundles(const MotionString& string,
                                                 const AccessibilityMatrix& accessibility,
                                                 int64_t longest,
                                                 const MotionBundleOptions& options,
                                                 const BundleResources& resources = {});

/// Quantile of |μ_s(j) - μ_s(j-1)| over adjacent letters inside clips: the lower of the two that it
/// falls between; 0 when there is no such pair. `quantile` in [0, 1].
double adjacent_step(const MotionString& string, const Mixture& mixture, double quantile);

/// Those of its ones for which |μ_a - μ_b| <= step as well. Clusters of large variance, which are
/// accessible from far away, no longer join what is different.
AccessibilityMatrix within_step(const AccessibilityMatrix& accessibility, const Mixture& mixture,
                                double step);

/// What letters may be matched: those that τ allows and that are no farther apart than
/// options.step_quantile of the adjacent steps; with BundleSpread::closure_near, than their median
/// at most.
AccessibilityMatrix accessibility_for_bundles(const AccessibilityMatrix& accessibility,
                                              const MotionString& string, const Mixture& mixture,
                                              const MotionBundleOptions& options);

}  // namespace kinetome
