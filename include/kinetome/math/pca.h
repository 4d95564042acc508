// Principal components of standardised features (S1 §3.2; methods: floored standardisation).
#pragma once

#include <cstdint>

#include "kinetome/base/matrix.h"
#include "kinetome/base/packing.h"
#include "kinetome/math/moments.h"

namespace kinetome {

/// y = componentsᵀ · ((x - mean) / scale).
struct Pca {
    VectorD mean;        ///< d, units of the features
    VectorD scale;       ///< d, max(standard deviation, floor)
    MatrixD components;  ///< d × D, orthonormal columns, largest variance first; the entry of
                         ///< largest magnitude of each column is positive
    VectorD variances;   ///< d, all eigenvalues of the standardised covariance, descending

    int64_t dimension() const { return components.cols(); }
    /// Share of the total variance that the kept components hold.
    double kept_share() const;

    /// rows (n × d) → n × D, row by row in double, rounded once to float.
    MatrixF project(const MatrixFView& rows) const;
};

void pack(Packer& out, const Pca& pca);
void unpack(Unpacker& in, Pca& pca);

/// Keeps the fewest components that hold at least `share` (0, 1] of the total variance (at least
/// one). `floor` (d, > 0) is the least scale of each feature: without it features that hardly move
/// are blown up to unit variance. Throws std::invalid_argument for fewer than two rows.
Pca fit_pca(const Moments& moments, const VectorD& floor, double share);

}  // namespace kinetome
