// What the neighbourhood graph of a take is built of, by the options of its stage.
#pragma once

#include "kinetome/base/matrix.h"
#include "kinetome/stages/options.h"

namespace kinetome {

/// The chosen effectors of n frames (n × 15), stacked with those before and after (S3 §5): n × 9m.
MatrixF graph_features(const MatrixFView& effectors, const ReindexOptions& options);

/// r of a take with these features, cm.
double graph_radius(const MatrixFView& features, const NeighborOptions& options);

}  // namespace kinetome
