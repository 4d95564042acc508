// The start of a fit whose floor is known already.
#pragma once

#include "kinetome/math/mixture.h"

namespace kinetome {

/// The absolute floor of the variances. Throws std::invalid_argument naming the first row that
/// holds a value that is not finite.
double checked_least_variance(const RowSource& rows, const MixtureOptions& options,
                              const Workers& workers);

/// start_mixture() with that floor.
Mixture start_mixture(const RowSource& rows, int64_t clusters, const MixtureOptions& options,
                      double least_variance, int restart, const Workers& workers);

}  // namespace kinetome
