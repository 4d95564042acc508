// A partition's pose vectors in the space of its principal components.
#pragma once

#include "kinetome/base/matrix.h"
#include "kinetome/math/pca.h"
#include "kinetome/stages/pose_rows.h"

namespace kinetome {

/// rows × D, read and projected piece by piece.
MatrixF project_rows(const PosePartition& partition, const Pca& pca, int threads,
                     const StopToken& stop);

}  // namespace kinetome
