// Primitives as movements rather than as poses: what labels are transferred by.
#pragma once

#include <span>

#include "kinetome/base/matrix.h"
#include "kinetome/models/corpus_primitive.h"

namespace kinetome {

/// Performers stand, hold their arms and are built differently, by as much as many movements
/// differ. What they do is told rather by how they move.
struct MovementOptions {
    double posture = 0.5;  ///< share of a primitive's mean pose that its rows keep
    double change = 4;     ///< what the way from the first to the last pose of a row counts
};

/// The rows of primitives, of three poses each one after another (n × 3m), without a part of the
/// primitive's mean row, and with m columns for the way from the first pose to the last (n × 4m).
/// Rows between primitives keep their mean. Throws std::invalid_argument for columns that are not a
/// multiple of three, for a primitive that is empty or lies outside the rows, and for a value in
/// one that is not finite.
MatrixF movement_rows(const MatrixFView& stacked, std::span<const CorpusPrimitive> primitives,
                      const MovementOptions& options = {});

}  // namespace kinetome
