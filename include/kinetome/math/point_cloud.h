// How alike two clouds of points are wherever they stand on the floor and whichever way they face
// (Kovar, Gleicher & Pighin 2002; Kovar & Gleicher 2004): the distance S3 §5.2 measures motion in.
#pragma once

#include "kinetome/base/matrix.h"

namespace kinetome {

/// Root mean square distance of corresponding points once the second cloud is turned about the
/// vertical and moved on the floor so that it is least. Each row holds x y z of p points, Y up, all
/// of one weight. n × 3p and m × 3p → n × m, in the unit of the points. Throws
/// std::invalid_argument when the rows do not hold points or not the same number of them.
MatrixD point_cloud_distances(const MatrixFView& first, const MatrixFView& second);

}  // namespace kinetome
