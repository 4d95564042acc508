// On which side of a plane values lie: one function for growth and classification, so that both
// round alike and a pose falls in the leaf that it helped to make.
#pragma once

#include <cstdint>

namespace kinetome {

/// normal · values of d values each.
double along_normal(const double* normal, const double* values, int64_t dimension);

}  // namespace kinetome
