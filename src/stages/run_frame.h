// What every run that publishes begins and ends with.
#pragma once

#include <tbb/global_control.h>

#include "kinetome/base/log.h"
#include "kinetome/base/resources.h"
#include "kinetome/run/meter.h"
#include "kinetome/stages/reindex.h"
#include "run_in_progress.h"

namespace kinetome {

/// oneTBB's share of the one thread count; OpenMP regions are given theirs explicitly.
tbb::global_control limit_threads(const Resources& resources);

void announce(const Resources& resources, const Log& log);

/// Publishes, then forgets the run in progress, unless it holds work of stages that were left out.
Publication publish_and_forget(RunInProgress& run, const RunPlan& plan,
                               const FinishedPlan& finished, bool copy);

/// `before` and `after`: what was finished before the run and after it.
RunSummary sum_up(Publication publication, const RunPlan& plan, const FinishedPlan& before,
                  const FinishedPlan& after, const Meter& meter);

}  // namespace kinetome
