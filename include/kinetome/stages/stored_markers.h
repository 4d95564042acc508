// Normalised markers of takes of a generation, in memory.
#pragma once

#include <string>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"
#include "kinetome/run/generation.h"

namespace kinetome {

/// Takes of one class of skeletons, in name order.
struct MarkerTakes {
    std::string clip_class;
    std::vector<std::string> marker_names;
    double rate = 0;  ///< frames a second
    std::vector<std::string> names;
    std::vector<RowRange> takes;  ///< each one's rows
    MatrixF poses;                ///< n × f, cm
};

/// Those whose names match one of some patterns (`*`, `?` and `[…]` as in a shell, separated by
/// commas; "" matches all), class by class. Throws UsageError when no take does.
std::vector<MarkerTakes> stored_markers(const Generation& generation, const std::string& patterns);

}  // namespace kinetome
