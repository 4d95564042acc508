// Members of motion bundles compared by what surrounds them.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"
#include "kinetome/models/bundle_links.h"

namespace kinetome {

/// A member that speaks for its bundle. Ranges are of all rows.
struct Occurrence {
    RowRange member;
    RowRange clip;
    int64_t middle() const { return (member.first + member.end - 1) / 2; }
};

/// How a member and its surroundings are found about another.
struct Agreement {
    double cost = std::numeric_limits<double>::infinity();  ///< mean distance along the path
    double unlikeness = 1;  ///< √(Σ|x - y|² / (Σ|x|² + Σ|y|²)) of what moves, each about its mean:
                            ///< 0 of the same movement, 1 of movements that share nothing
};

class MemberAgreement {
  public:
    /// `rows` by their metric (member_metric.h).
    MemberAgreement(MatrixF rows, std::vector<Occurrence> occurrences,
                    const BundleLinkOptions& options);

    /// How far the middle of the one is from the nearest row that it may answer in the other.
    double glance(size_t from, size_t to) const;

    /// Never more than that, and sooner found.
    double glance_bound(size_t from, size_t to) const;

    /// The cheapest path through the middle of the one and a row that it may answer in the other,
    /// over the surroundings of the one, if before and after the middle it costs `at_most` each; an
    /// infinite cost when none does.
    Agreement find(size_t from, size_t to, double at_most) const;

    bool share_surroundings(size_t a, size_t b) const;

  private:
    /// Rows that the middle of another member may answer in this: its own, but for a slip.
    RowRange answers(size_t to) const;

    MatrixF rows_;
    MatrixF columns_;  ///< the same, an axis after the other, and columns to spare
    MatrixF centres_;  ///< by member, of the rows that may answer
    VectorF radii_;    ///< about those
    std::vector<Occurrence> occurrences_;
    BundleLinkOptions options_;
};

}  // namespace kinetome
