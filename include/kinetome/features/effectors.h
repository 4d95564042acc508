// End-effector features (S3 §3): where head, hands and feet are, seen from the root.
#pragma once

#include "kinetome/base/matrix.h"
#include "kinetome/formats/clip.h"

namespace kinetome {

/// frames × 15: head, left wrist, right wrist, left ankle, right ankle in the root's own frame
/// (full root rotation removed), cm.
MatrixF effector_positions(const Clip& clip);

/// n × 3d: each row with those `offset` rows before and after it, indices clamped to the clip
/// (S3 §3: F45 at 30 Hz from rows of 15).
MatrixF stack_neighbours(const MatrixFView& rows, int64_t offset = 1);

}  // namespace kinetome
