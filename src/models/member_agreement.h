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

    /// No path from the one in the surroundings of the other costs less. Two bounds, the second of
    /// which is tighter and takes longer: how far what both pass through lies apart.
    double rough_bound(size_t from, size_t to) const;
    double bound(size_t from, size_t to) const;

    /// The cheapest path of at most `at_most` on which both move alike: what remains of their
    /// movements is at most `unlikeness`, or the options' share of what they move. An infinite cost
    /// when there is none.
    Agreement find(size_t from, size_t to, double at_most, double unlikeness) const;

    bool share_surroundings(size_t a, size_t b) const;

  private:
    bool answers(const WarpPath& path, const Occurrence& from, const Occurrence& to) const;

    MatrixF rows_;  ///< along main axes
    std::vector<Occurrence> occurrences_;
    BundleLinkOptions options_;
    MatrixD query_low_, query_high_, low_, high_;  ///< occurrences × axes: boxes about their rows
};

}  // namespace kinetome
