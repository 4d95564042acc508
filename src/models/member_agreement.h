// Members of motion bundles compared by what surrounds them.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"
#include "kinetome/math/warp.h"
#include "kinetome/models/bundle_links.h"

namespace kinetome {

/// A member that speaks for its bundle. Ranges are of all rows.
struct Occurrence {
    RowRange member;
    RowRange query;     ///< it and what surrounds it
    RowRange sequence;  ///< in which others are looked for
};

/// How a member is found in the surroundings of another.
struct Agreement {
    double cost = std::numeric_limits<double>::infinity();  ///< mean distance along the path
    double unlikeness = 0;  ///< of their movements about their means, Σ|x - y|² a cell
};

class MemberAgreement {
  public:
    /// Rows are compared along the main axes of those of `occurrences`.
    MemberAgreement(const MatrixFView& rows, std::vector<Occurrence> occurrences,
                    const BundleLinkOptions& options);

    /// How far the middle row of the one member is from the nearest of the other's, but for a slip.
    double glance(size_t from, size_t to) const;
    /// No path from the one in the surroundings of the other costs less; infinite as soon as that
    /// is above `at_most`.
    double bound(size_t from, size_t to, double at_most) const;

    /// The cheapest path of at most `at_most` on which both move alike: what remains of their
    /// movements is at most `unlikeness`, or the options' share of what they move. An infinite cost
    /// when there is none.
    Agreement find(size_t from, size_t to, double at_most, double unlikeness) const;

    bool share_surroundings(size_t a, size_t b) const;

  private:
    bool answers(const WarpPath& path, const Occurrence& from, const Occurrence& to) const;

    MatrixF rows_;     ///< along main axes
    MatrixF columns_;  ///< the same, an axis after the other
    std::vector<Occurrence> occurrences_;
    BundleLinkOptions options_;
};

}  // namespace kinetome
