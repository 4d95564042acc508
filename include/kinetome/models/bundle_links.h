// Bundles of different bodies that hold the same motion. Each subject has letters of its own, so
// that strings cannot tell; what can is how points of the bodies move, in leg lengths.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"
#include "kinetome/models/bundle_graph.h"

namespace kinetome {

inline constexpr double bundle_link_rate = 30;    ///< rows a second
inline constexpr int64_t bundle_link_offset = 3;  ///< of grounded_points: a tenth of a second

struct BundleLinkOptions {
    int64_t surroundings = 50;  ///< rows: members shorter than λ' (S1 §3.6: 200 frames at 120 Hz)
                                ///< are compared with what surrounds them, so much in all
    int64_t slip = 6;           ///< rows that a member may begin later, or end sooner, than the
                                ///< other: bundles of a cycle are cut at any phase
    double gamma = 0.8;         ///< least ratio of lengths, as between members (S1 §3.3)
    double unlike = 0.5;        ///< share of what both move that they may move differently
    double reach = 2;           ///< times the usual cost between members of one bundle
    int64_t members = 4;        ///< of each bundle, evenly spaced, that speak for it
};

/// Two bundles of different subjects, and rows of their clips at which one may be left for the
/// other.
struct BundleLink {
    int32_t first = 0, second = 0;  ///< bundles; the first is the lower one
    double cost = 0;                ///< mean distance of rows that answer each other
    int32_t first_clip = 0, second_clip = 0;
    int64_t first_row = 0, second_row = 0;  ///< of the clips
    bool operator==(const BundleLink&) const = default;
};

struct BundleLinks {
    double usual_cost = 0;  ///< median over members of the least cost to another of their bundle
                            ///< that shares no surroundings; 0 when no bundle has two such
    std::vector<BundleLink> links;  ///< by first and second; none when the usual cost is 0
};

/// `rows` (n × d) are grounded_points in leg lengths, those of clip c at clips[c]; `members` those
/// of bundles with several, in rows of their clip, in any order; `subject_of` names the subject of
/// each clip. Members of a bundle are of one subject.
///
/// A member with its surroundings is looked for in the surroundings of another by subsequence time
/// warping (slope_limited_steps). They hold the same motion when the path leads from the one to the
/// other within `slip`, takes both about equally long (γ), costs at most `reach` usual costs, and
/// when what remains of their movement about the mean of each (Σ|x - y|²) is at most `unlike` of
/// what they move (Σ|x|² + Σ|y|²): a left and a right punch are close, but share no movement. Two
/// bundles are linked when a member of each is so found from a member of the other; rows are of the
/// cheapest path from the first (ties: by members). The same for any number of threads. Throws
/// std::invalid_argument when the lists disagree and for options that are not positive.
BundleLinks link_bundles(const MatrixFView& rows, std::span<const RowRange> clips,
                         std::span<const BundleMember> members, std::span<const int32_t> subject_of,
                         const BundleLinkOptions& options, int threads);

}  // namespace kinetome
