#include "kinetome/stages/segmentation_options.h"

#include <algorithm>

namespace kinetome {

SegmentationOptions segmentation_options(const ReindexOptions& options,
                                         const GraphTakePlace& take) {
    SegmentationOptions result =
        adapted({options.activities, options.primitives, options.primitive_clusters},
                options.features.effector_rate, take.clip.radius / options.neighbors.knn.radius);
    for (double* radius :
         {&result.activities.repetition.radius, &result.activities.region_growing.radius,
          &result.primitives.cost_ridges.radius, &result.primitives.warping_paths.radius,
          &result.clusters.radius}) {
        *radius = std::min(*radius, take.clip.radius);  // no graph has longer edges
    }
    return result;
}

CutClip cut_clip(const GraphTakePlace& take) {
    const NeighborClip& clip = take.clip;
    return {clip.name, clip.clip_class, take.frames, clip.source_frames, clip.source_rate};
}

}  // namespace kinetome
