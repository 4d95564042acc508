// The features of primitives.
#pragma once

#include <span>

#include "kinetome/base/matrix.h"
#include "kinetome/models/corpus_primitive.h"

namespace kinetome {

/// Throws std::invalid_argument for a primitive that is empty or lies outside the features, and for
/// a value in one that is not finite.
void require_rows(const MatrixFView& features, std::span<const CorpusPrimitive> primitives);

inline MatrixFView rows_of(const MatrixFView& features, const CorpusPrimitive& primitive) {
    return features.middleRows(primitive.rows.first, primitive.rows.size());
}

}  // namespace kinetome
