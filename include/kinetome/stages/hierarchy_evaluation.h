// The piecewise-linear model on takes of a store (S2 §6): how small and exact it makes them, and
// how well it estimates motion that it has not seen (`evaluate --what compression|estimation`).
#pragma once

#include <string>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/models/estimation_score.h"
#include "kinetome/stages/export.h"
#include "kinetome/stages/stored_markers.h"

namespace kinetome {

struct HierarchyEvaluationOptions {
    PrincipalMarkerOptions principal_markers;
    PoseHierarchyOptions hierarchy;
};

/// frames, takes or blocks; "all" for each of them. Throws UsageError for another word.
std::vector<HeldOut> parse_held_out(const std::string& word);

/// Of fewer than 14 takes the last is held out. A line a class, way of holding out and method:
/// class,held_out,principal,leaves,trained,tested,
/// method,rms_mm,p95_mm,max_mm,to_linear,to_nearest; errors over estimated markers, the last two as
/// multiples of the RMS of the linear map and of the nearest pose, empty where these are 0. Throws
/// UsageError when there are too few takes to hold one out.
Table estimation_table(const std::vector<MarkerTakes>& classes, const std::vector<HeldOut>& ways,
                       const HierarchyEvaluationOptions& options, const Workers& workers);

/// A line a class: class,frames,principal,leaves,ratio,ratio_paper,rms_mm,p95_mm,max_mm. `ratio`
/// counts numbers: of leaves (mean and basis), planes, coordinates, and one a run of frames in a
/// leaf; `ratio_paper` as S2 §5.1, C f k + N k.
Table compression_table(const std::vector<MarkerTakes>& classes,
                        const HierarchyEvaluationOptions& options, const Workers& workers);

}  // namespace kinetome
