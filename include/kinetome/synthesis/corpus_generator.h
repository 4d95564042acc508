// Writes a whole corpus with known truth: folders of subjects, takes, truth.csv and cycles.csv.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "kinetome/base/stop.h"
#include "kinetome/formats/annotation.h"
#include "kinetome/synthesis/take_plan.h"

namespace kinetome {

enum class MotionFormat { amc, bvh };

struct GenerateOptions {
    int64_t frames = 0;                       ///< of all takes together, exactly; at 120 Hz
    uint64_t seed = 1;                        ///< same seed, same bytes
    MotionFormat format = MotionFormat::amc;  ///< of the takes
    int64_t subjects = 0;                     ///< performers; 0: one for about 12 takes
    std::filesystem::path from{};             ///< vary the takes of this corpus; empty: procedural
};

struct GenerateSummary {
    int64_t frames = 0, takes = 0, subjects = 0, segments = 0, cycles = 0;
};

/// Called after each take with its frames, from any thread.
using FramesDone = std::function<void(int64_t)>;

/// Writes SS/SS.asf, SS/SS_TT.amc (or SS/SS_TT.bvh), truth.csv and cycles.csv below `folder`, which
/// must not exist or be empty. Takes are made in parallel, each held in memory alone; the bytes do
/// not depend on `threads`. The corpus appears whole: it grows in "<folder>.incomplete", which is
/// replaced when it is found and renamed at the end. Throws UsageError, CreateError and
/// Interrupted.
GenerateSummary generate_corpus(const GenerateOptions& options, const std::filesystem::path& folder,
                                int threads, const FramesDone& frames_done = {},
                                const StopToken& stop = {});

/// The rows a planned take contributes to the truth.
Annotations annotate(const TakePlan& plan);

}  // namespace kinetome
