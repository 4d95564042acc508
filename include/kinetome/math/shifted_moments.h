// Count, sum and second moment about a fixed point: what sums over the same point need no
// correction to be added, and what a point near the mean keeps from cancelling.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/packing.h"
#include "kinetome/math/moments.h"

namespace kinetome {

/// Of d values about a point that whoever sums must remember.
struct ShiftedMoments {
    int64_t count = 0;
    VectorD sum;                 ///< d, Σ (x - point)
    std::vector<double> second;  ///< d (d + 1) / 2, the upper triangle of Σ (x - point)(x -
                                 ///< point)ᵀ, row by row
};

/// Of the rows named in `selected` (ascending; of rows, n × d), added in that order, in double.
ShiftedMoments shifted_moments(const MatrixFView& rows, std::span<const int32_t> selected,
                               const VectorD& point);

/// Adds `right`, about the same point, to `left`.
void merge(ShiftedMoments& left, const ShiftedMoments& right);

/// The same about the mean. Throws std::invalid_argument without rows.
Moments about_mean(const ShiftedMoments& shifted, const VectorD& point);

/// Bytes of the sums of d values.
int64_t shifted_moment_bytes(int64_t dimension);

void pack(Packer& out, const ShiftedMoments& moments);
void unpack(Unpacker& in, ShiftedMoments& moments);

}  // namespace kinetome
