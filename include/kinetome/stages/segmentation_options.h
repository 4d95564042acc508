// How a take of the corpus is cut, by the options of a run.
#pragma once

#include "kinetome/models/take_segmentation.h"
#include "kinetome/stages/graph_takes.h"
#include "kinetome/stages/options.h"
#include "kinetome/stages/segment_file.h"

namespace kinetome {

/// Distances are in proportion to the radius that the take's graph was searched within.
SegmentationOptions segmentation_options(const ReindexOptions& options, const GraphTakePlace& take);

CutClip cut_clip(const GraphTakePlace& take);

}  // namespace kinetome
