// Primitives of takes against their annotation (`evaluate --what primitives`).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinetome/models/primitive_score.h"
#include "kinetome/stages/evaluation.h"
#include "kinetome/stages/export.h"
#include "kinetome/stages/segment_table.h"

namespace kinetome {

struct PrimitiveEvaluation {
    struct Take {
        std::string clip;
        PrimitiveScore score;  ///< purity of clusters as far as they lie in the take
    };
    std::vector<Take> takes;  ///< annotated ones, by name
    PrimitiveScore total;     ///< purity of clusters over all takes
};

/// A take without primitives counts with none. Clips without annotation are left out. Throws
/// InputError naming `cycles_path` and a line for a cycle that leaves its take or whose clip has no
/// annotation, and naming `primitives_path` and a clip for a primitive that leaves its take.
PrimitiveEvaluation evaluate_primitives(std::span<const AnnotatedTake> takes,
                                        std::span<const PrimitivesOfTake> primitives,
                                        const std::string& primitives_path,
                                        std::span<const CycleRow> cycles,
                                        const std::string& cycles_path);

/// what,name and one column a figure; what is take or total.
Table evaluation_table(const PrimitiveEvaluation& evaluation);

}  // namespace kinetome
