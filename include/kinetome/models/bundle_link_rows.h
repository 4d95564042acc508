// Motion as bundles of different bodies are compared by it.
#pragma once

#include <cstdint>

#include "kinetome/base/matrix.h"
#include "kinetome/formats/clip.h"

namespace kinetome {

inline constexpr double bundle_link_rate = 15;  ///< rows a second: a blow lasts several

/// Whether a skeleton has the joints that bundle_link_rows asks for.
bool has_bundle_link_rows(const Skeleton& skeleton);

/// n × 99 at bundle_link_rate, in leg lengths (hip to ankle): grounded_points of head, neck,
/// elbows, wrists, knees and ankles, with those of the rows before and after. Limbs tell a walk
/// from a run where their ends alone do not. Throws std::invalid_argument for a skeleton without
/// one of these joints.
MatrixF bundle_link_rows(const Clip& clip);

}  // namespace kinetome
