// How rank 0 leads a run and the other ranks take part in it.
#pragma once

#include <string>

#include "kinetome/base/communicator.h"
#include "kinetome/stages/execution.h"
#include "kinetome/stages/plan.h"
#include "kinetome/stages/reindex.h"

namespace kinetome {

/// Rank 0 says first whether all survey the corpus together, then what is to be done.
void order_survey(bool wanted, Communicator& ranks);
void order_work(const RunPlan& plan, const FinishedPlan& finished, Communicator& ranks);

/// A rank's part in a run that rank 0 leads: obeys both orders.
void assist(const ReindexRequest& request, const Selection& selection, Communicator& ranks, Log log,
            const StopToken& stop);

}  // namespace kinetome
