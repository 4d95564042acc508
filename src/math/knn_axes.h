// The leading principal axes of rows: a few coordinates that hold nearly all of a distance.
// Between projected rows a distance is never longer than between the rows themselves (the lower
// bound of filter and refine searches: Faloutsos, Ranganathan & Manolopoulos 1994).
#pragma once

#include <cstdint>

#include "kinetome/base/matrix.h"

namespace kinetome {

class LeadingAxes {
  public:
    /// Those of evenly spaced rows: which axes they are decides how fast, never what is found.
    explicit LeadingAxes(const MatrixFView& rows);

    int64_t dimension() const { return axes_.cols(); }

    /// Projects rows (n × d) into `projected` (n × dimension()).
    /// `slack` (n): how far each may lie from the true projection, at most.
    void project(const MatrixFView& rows, MatrixF& projected, VectorF& slack) const;

  private:
    VectorD mean_;
    MatrixD axes_;  ///< d × dimension(), orthonormal columns
};

}  // namespace kinetome
