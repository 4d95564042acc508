// What the mixture's functions ask of the rows they are given.
#pragma once

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"

namespace kinetome {

/// Throws std::invalid_argument naming the first row that holds a value that is not finite.
void require_finite(const MatrixFView& rows);

/// Throws std::invalid_argument when the layout is one of another number of rows.
void require_layout_of(const MatrixFView& rows, const PieceLayout& layout);

/// Throws std::invalid_argument unless the rows have the model's dimension, and that is not zero.
void require_dimension_of(const MatrixFView& rows, int64_t dimension);

}  // namespace kinetome
