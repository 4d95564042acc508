// What the bundles that are near either of two tell about these.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "bundle_distances.h"

namespace kinetome {

/// Of each bundle those that have a member near it, of all bodies: two bundles are told apart by
/// what others have in common with them. Bundles are named by their places in Speakers.
class BundleNeighbours {
  public:
    /// `within` is that of BundleDistances, `subject_of` that of Speakers.
    BundleNeighbours(std::span<const BundleDistance> within, std::span<const int32_t> subject_of);

    /// Do two that agree do so with this share of the same bundles, of those of the one with
    /// fewer? True where these are too few to tell.
    bool keep_company(int32_t a, int32_t b, double share) const;

    /// Do more third bodies speak against two, which are `most` apart, than for them? A body
    /// speaks for them when a bundle of it is near both; against, when one agrees with one of them
    /// and is no farther from it than the other is, but none agrees with both.
    bool contradict(int32_t a, int32_t b, double most) const;

  private:
    /// A bundle, of whichever body, of which a member is near.
    struct Neighbour {
        int32_t subject = 0;
        int32_t bundle = 0;
        double most = 0;      ///< as in BundleDistance
        bool agrees = false;  ///< as BundleDistance tells

        std::pair<int32_t, int32_t> place() const { return {subject, bundle}; }
    };

    const std::vector<Neighbour>& of(int32_t bundle) const {
        return neighbours_[static_cast<size_t>(bundle)];
    }

    /// Calls visit(one, other) for every bundle that is a neighbour of either, by subject and
    /// bundle, with null for what it is no neighbour of.
    template <class Visit>
    void visit_neighbours_of_either(int32_t a, int32_t b, const Visit& visit) const;

    std::vector<int32_t> subject_of_;
    std::vector<std::vector<Neighbour>> neighbours_;  ///< by bundle: by subject and bundle
};

}  // namespace kinetome
