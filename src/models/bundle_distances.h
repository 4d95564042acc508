// How far bundles are from each other, by how members that speak for them move.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"
#include "kinetome/models/bundle_links.h"
#include "member_agreement.h"

namespace kinetome {

/// Bundles by number, and the members that speak for each.
struct Speakers {
    std::vector<int32_t> bundles;                ///< ascending
    std::vector<int32_t> subject_of;             ///< by place in `bundles`
    std::vector<std::vector<size_t>> of_bundle;  ///< by place: numbers of occurrences
    std::vector<Occurrence> occurrences;
};

/// Of bundles with more members than options ask for some, evenly spaced by clip and row.
Speakers speakers_of(std::span<const RowRange> clips, std::span<const BundleMember> members,
                     std::span<const int32_t> subject_of, const BundleLinkOptions& options);

/// What moves wholly unlike may be as far apart as members of one bundle usually are; what moves
/// more alike, farther in proportion.
constexpr double farthest = 1;

/// How far two bundles are apart, both ways. Bundles are named by their places in Speakers.
struct BundleDistance {
    int32_t first = 0, second = 0;  ///< the first is the lower one
    double nearest = 0;             ///< by the members of either that are nearest to the other
    double most = 0;                ///< within which most members of either are from the other

    bool agree() const { return most <= farthest; }  ///< are most members of either near?
};

struct BundleDistances {
    double usual_cost = 0;               ///< as in BundleLinks
    std::vector<BundleDistance> within;  ///< whose nearest members are no farther than `farthest`,
                                         ///< by first and second
};

/// Of bundles that look alike, of one body or of two (bundle_links.h).
BundleDistances bundle_distances(const MatrixFView& rows, const Speakers& speakers,
                                 const BundleLinkOptions& options, const Workers& workers);

}  // namespace kinetome
