// Bundles of different bodies that hold the same motion. Each subject has letters of its own, so
// that strings cannot tell; what can is how points of the bodies move (bundle_link_rows.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"
#include "kinetome/models/bundle_graph.h"

namespace kinetome {

struct BundleLinkOptions {
    int64_t surroundings = 45;  ///< rows about a member that are compared with it, so much in all:
                                ///< three seconds tell sitting down from squatting
    int64_t slip = 3;           ///< rows that a member may begin later, or end sooner, than the
                                ///< other: bundles of a cycle are cut at any phase
    double reach = 2.5;         ///< times the usual cost between members of one bundle
    int64_t members = 3;        ///< of each bundle, evenly spaced, that speak for it
    int64_t candidates = 12;    ///< of each body with which a bundle is compared: those whose
                                ///< middles are nearest
    double company = 0.4;       ///< share of the bundles that agree with the one of two, of those
                                ///< of the one with fewer, that must agree with the other, too
};

/// Two bundles of different subjects.
struct BundleLink {
    int32_t first = 0, second = 0;  ///< bundles; the first is the lower one
    double cost = 0;  ///< how far apart most members of either are, or the nearest ones where only
                      ///< their kinds tell that they are linked: 0 to 1
    bool operator==(const BundleLink&) const = default;
};

struct BundleLinks {
    double usual_cost = 0;  ///< median over members of the least cost to another of their bundle
                            ///< that shares no surroundings; 0 when no bundle has two such
    std::vector<int32_t> kind_of;   ///< by bundle: its kind of motion, named by its lowest bundle
    std::vector<BundleLink> links;  ///< by first and second; none when the usual cost is 0
};

/// `rows` (n × d) are bundle_link_rows, those of clip c at clips[c]; `members` those of bundles
/// with several, in rows of their clip, in any order; `subject_of` names the subject of each clip.
/// Members of a bundle are of one subject.
///
/// Rows are compared along their 16 main axes, whitened by how members of a bundle differ. A
/// member with its surroundings is laid along the take of another, by time warping
/// (slope_limited_steps) through the middle of the one and a row of the other, but for `slip`.
/// A path's cost is the mean distance along it. Two members are as far apart as the path's cost, in
/// usual ones, times how unlike the movements along it are, each about its mean:
/// √(Σ|x - y|² / (Σ|x|² + Σ|y|²)), 0 of the same movement, 1 of two that share nothing. At most 1
/// is near: what moves wholly unlike may be as far apart as members of one bundle usually are, what
/// moves more alike farther in proportion, up to `reach`. A left and a right punch are near, but
/// share no movement. Bundles agree when most members of either are near to one of the other, so
/// that a member which is in its bundle by mistake does not speak for it.
///
/// A bundle is compared with `candidates` of each body, those which look nearest by middles of
/// members, and with those of which it is one. Two that agree keep company when they agree with
/// `company` of the same ones, or when either agrees with fewer than two others: shared neighbours
/// tell more than distances do (Jarvis & Patrick 1973). Bundles of one body that agree and keep
/// company, and those that do so with these, are one kind of motion. A bundle is linked with the
/// nearest of each other body that agrees with it (ties: the lower one), if they keep company,
/// unless that one is nearer to another kind of motion of the first's body: what that body does
/// otherwise tells apart better than any distance between two bodies. What is then without a link
/// is linked with the nearest, by any member (ties: the lower one), of those bundles of other
/// bodies that are near, of a kind that is linked with its own, and not contradicted.
///
/// Two are contradicted, and never linked, when more third bodies speak against than for them. A
/// body speaks for two when a bundle of it has a member near to each of them; against them when a
/// bundle of it agrees with one and is no farther from it, by most members, than the two are from
/// each other, but none agrees with both.
///
/// Every rank calls with the same; the result is the same at each, for any number of them and of
/// threads. Throws std::invalid_argument when the lists disagree and for options that are not
/// positive.
BundleLinks link_bundles(const MatrixFView& rows, std::span<const RowRange> clips,
                         std::span<const BundleMember> members, std::span<const int32_t> subject_of,
                         const BundleLinkOptions& options, const Workers& workers);

}  // namespace kinetome
