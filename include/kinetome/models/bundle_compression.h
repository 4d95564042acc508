// Motion bundles as compression (S1 §6): one member of each is kept, and stands for the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "kinetome/base/matrix.h"

namespace kinetome {

/// The member that stands for a bundle: the one whose length is nearest to the mean, the first of
/// several. Throws std::invalid_argument for no member.
size_t representative_of(std::span<const double> lengths);

/// Poses of a member (n × f normalised markers, cm) shown by those of another (m × f) that dynamic
/// time warping answers them with, the nearest where there are several: the sum over frames and
/// coordinates of squared differences, cm². Throws std::invalid_argument for poses of different
/// columns, and for no pose.
double squared_stand_in_error(const MatrixFView& member, const MatrixFView& representative);

}  // namespace kinetome
