// Rows measured by what tells members of different bundles apart.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"

namespace kinetome {

/// Rows (n × d) along their 16 main axes, whitened by how members of one bundle differ (relevant
/// component analysis, Bar-Hillel, Hertz, Shental & Weinshall 2003): whatever performances of one
/// motion vary in counts little, whatever they keep to counts much. Bundles say which performances
/// these are, so that no label is needed.
///
/// `members` are ranges of rows, those of bundle b numbered in bundles[b]. Axes are those of rows
/// in members; a row of the one differs from the nearest of another. Left as they are along
/// their axes where no bundle has two members. The same for any number of threads.
MatrixF rows_by_member_metric(const MatrixFView& rows, std::span<const RowRange> members,
                              std::span<const std::vector<size_t>> bundles);

}  // namespace kinetome
