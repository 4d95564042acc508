// What the mixture's functions ask of the rows they are given.
#pragma once

#include "kinetome/base/matrix.h"
#include "kinetome/math/moments.h"
#include "kinetome/math/row_source.h"

namespace kinetome {

/// Throws std::invalid_argument naming the first row that holds a value that is not finite; rows
/// are counted from `first_row`.
void require_finite(const MatrixFView& rows, int64_t first_row);

/// The same of all rows, whose moments tell whether there is such a value.
void require_finite(const RowSource& rows, const Moments& moments);

/// Throws std::invalid_argument unless rows of so many columns have the model's dimension, and that
/// is not zero.
void require_dimension_of(int64_t columns, int64_t dimension);

}  // namespace kinetome
