// Signatures that know where their runs lie, so that motions are compared by more than which leaves
// they pass through: two motions of one leaf still differ along its components (S2 §5.3).
#pragma once

#include <cstdint>

#include "kinetome/base/matrix.h"
#include "kinetome/models/pose_hierarchy.h"
#include "kinetome/models/signature.h"

namespace kinetome {

/// r: of poses of f columns.
int64_t signature_axis_count(int64_t columns);

/// f × r: what poses (cm) are multiplied by for positions, whose Euclidean distances are
/// those between poses in mm per marker, the origin among the f / 3 markers. The r directions in
/// which the poses of a hierarchy differ most; along the others they hardly do.
MatrixF signature_axes(const PoseHierarchy& hierarchy);

/// Of poses (n × f, cm), n × r.
MatrixF positions_of(const MatrixDView& poses, const MatrixF& axes);

/// n runs and their positions.
struct PlacedSignature {
    Signature runs;
    MatrixF positions;  ///< n × r
};

/// A motion's runs lie where the means of their poses (frames × f, cm) do. Throws
/// std::invalid_argument when the signature has not as many frames as there are poses.
PlacedSignature place_signature(Signature signature, const MatrixFView& poses, const MatrixF& axes);

}  // namespace kinetome
