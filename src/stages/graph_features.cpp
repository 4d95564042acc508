#include "kinetome/stages/graph_features.h"

#include <cmath>

#include "kinetome/features/effectors.h"
#include "kinetome/models/adapted_radius.h"

namespace kinetome {

MatrixF graph_features(const MatrixFView& effectors, const ReindexOptions& options) {
    const NeighborOptions& asked = options.neighbors;
    return stack_neighbours(select_effectors(effectors, asked.joints),
                            std::llround(asked.stack_offset * options.features.effector_rate));
}

double graph_radius(const MatrixFView& features, const NeighborOptions& options) {
    const size_t joints = options.joints.size();
    const double radius = radius_for_effectors(options.knn.radius, joints);
    if (options.adapt_radius <= 0) return radius;
    const double least = radius_for_effectors(RadiusAdaptation().least, joints);
    return adapted_radius(features, radius, {options.adapt_radius, least});
}

}  // namespace kinetome
