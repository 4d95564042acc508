// Bundles of different bodies that hold the same motion. Each subject has letters of its own, so
// that strings cannot tell; what can is how points of the bodies move (bundle_link_rows.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"
#include "kinetome/models/bundle_graph.h"

namespace kinetome {

struct BundleLinkOptions {
    int64_t surroundings = 25;  ///< rows: members shorter than λ' (S1 §3.6: 200 frames at 120 Hz)
                                ///< are compared with what surrounds them, so much in all
    int64_t slip = 3;           ///< rows that a member may begin later, or end sooner, than the
                                ///< other: bundles of a cycle are cut at any phase
    double reach = 2.5;         ///< times the usual cost between members of one bundle
    double own_reach = 2;       ///< the same between bundles of one body
    double unlike = 0.15;       ///< share of what both move that they may move differently
    int64_t members = 2;        ///< of each bundle, evenly spaced, that speak for it
    int64_t candidates = 8;     ///< of each body with which a bundle is compared: those whose
                                ///< middles are nearest
};

/// Two bundles of different subjects.
struct BundleLink {
    int32_t first = 0, second = 0;  ///< bundles; the first is the lower one
    double cost = 0;                ///< mean distance of rows that answer each other
    bool operator==(const BundleLink&) const = default;
};

struct BundleLinks {
    double usual_cost = 0;  ///< median over members of the least cost to another of their bundle
                            ///< that shares no surroundings; 0 when no bundle has two such
    double usual_unlikeness = 0;    ///< what remains there of their movement, a row
    std::vector<int32_t> kind_of;   ///< by bundle: its kind of motion, named by its lowest bundle
    std::vector<BundleLink> links;  ///< by first and second; none when the usual cost is 0
};

/// `rows` (n × d) are bundle_link_rows, those of clip c at clips[c]; `members` those of bundles
/// with several, in rows of their clip, in any order; `subject_of` names the subject of each clip.
/// Members of a bundle are of one subject.
///
/// Rows are compared along their 16 main axes. A member with its surroundings is looked for in the
/// surroundings of another by subsequence time warping (slope_limited_steps). They hold the same
/// motion when the middle of what answers the one lies in the other or the reverse, but for `slip`,
/// when the path costs at most `reach` usual costs and the middle of the one is no farther from the
/// nearest row of the other, and when what remains of their movement about the mean of each
/// (Σ|x - y|²) is usual, or at most `unlike` of what they move (Σ|x|² + Σ|y|²): a left and a right
/// punch are close, but share no movement. Bundles agree when a member of each is so found from a
/// member of the other; they are as far apart as the dearer of the two cheapest paths.
///
/// A bundle is compared with `candidates` of each body, those which look nearest by middles of
/// members. Bundles of one body that agree within `own_reach` usual costs, and those that agree
/// with these, are one kind of motion. A bundle is linked with the nearest of each other body that
/// agrees with it (ties: the lower one), unless that one is nearest to another kind of motion of
/// the first's body: what that body does otherwise tells apart better than any distance between two
/// bodies. The same for any number of threads. Throws std::invalid_argument when the lists disagree
/// and for options that are not positive.
BundleLinks link_bundles(const MatrixFView& rows, std::span<const RowRange> clips,
                         std::span<const BundleMember> members, std::span<const int32_t> subject_of,
                         const BundleLinkOptions& options, int threads);

}  // namespace kinetome
