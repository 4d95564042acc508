// The whole body of a take from its principal markers alone (S2 §5.2).
#pragma once

#include <cstdint>
#include <vector>

#include "kinetome/formats/clip.h"
#include "kinetome/models/marker_maps.h"
#include "kinetome/run/generation.h"
#include "kinetome/stages/export.h"
#include "kinetome/stages/pose_hierarchy_file.h"

namespace kinetome {

/// A take seen through a model, frame by frame, at the model's rate.
struct TakeEstimate {
    Clip take;      ///< at that rate
    MatrixF truth;  ///< n × f, cm: its normalised markers
    MatrixF poses;  ///< n × f, cm: principal markers as they are, the others estimated
    std::vector<double> errors;   ///< n, mm: RMS over the estimated markers, origin not counted
    std::vector<int32_t> leaves;  ///< n
    double rms = 0;               ///< mm per estimated marker, of all frames
};

/// The model of a take's class. Throws UsageError when the generation has none.
ClassHierarchy model_for(const Generation& generation, const Clip& take);

/// Throws UsageError when the take has no frames.
TakeEstimate estimate_take(const ClassHierarchy& model, const Clip& take,
                           double blend_band = default_blend_band);

/// The take's skeleton fitted to the estimated poses, where the take's root is and facing as it
/// does.
Clip estimated_motion(const TakeEstimate& estimate);

/// frame,error_mm,leaf,leaf_changes: what an error meter shows (S2 Figure 2).
Table meter_table(const TakeEstimate& estimate);

}  // namespace kinetome
