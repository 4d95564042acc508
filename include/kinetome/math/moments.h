// Mergeable first and second moments: one pass, pieces in any number, one result.
#pragma once

#include <cstdint>

#include "kinetome/base/communicator.h"
#include "kinetome/base/matrix.h"
#include "kinetome/base/packing.h"
#include "kinetome/math/row_source.h"

namespace kinetome {

/// Count, mean and scatter about the mean of rows of d values (Chan, Golub & LeVeque 1983).
struct Moments {
    int64_t count = 0;
    VectorD mean;     ///< d
    MatrixD scatter;  ///< d × d, Σ (x - mean)(x - mean)ᵀ, symmetric

    int64_t dimension() const { return mean.size(); }
};

/// Moments of the rows (n × d) in double, rows in order.
Moments moments_of(const MatrixFView& rows);

/// Adds `right` to `left`; an empty side changes nothing. Throws std::invalid_argument when the
/// dimensions differ.
void merge(Moments& left, const Moments& right);

/// Moments of all rows, over their pieces in the fixed tree; the same at every rank.
Moments moments_of(const RowSource& rows, const Workers& workers);

void pack(Packer& out, const Moments& moments);
void unpack(Unpacker& in, Moments& moments);

}  // namespace kinetome
