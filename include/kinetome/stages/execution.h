// Carrying out a plan: each piece of work is reused when its key is complete, else made.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/log.h"
#include "kinetome/base/resources.h"
#include "kinetome/base/stop.h"
#include "kinetome/run/workspace.h"
#include "kinetome/stages/plan.h"

namespace kinetome {

/// What of a plan is to be carried out now.
struct Selection {
    std::set<std::string> stages;  ///< empty: all
    std::optional<Slice> slice;    ///< of the shards; stages that make one file are left out then
    bool copies = false;  ///< publishing will copy files instead of linking them: room for both
};

/// Finished work by position in the plan; nothing where it was neither found nor selected.
using FinishedPlan = std::vector<std::optional<FinishedWork>>;

/// Positions in plan.work of what is selected and not finished.
std::vector<size_t> work_to_make(const RunPlan& plan, const FinishedPlan& finished,
                                 const Selection& selection);

/// Throws CreateError when the disk has too little room for selected work that is not finished.
void require_room(const RunPlan& plan, const FinishedPlan& finished, const Selection& selection,
                  const Workspace& workspace);

/// Finds what is finished of the selected work (each file is hashed), and makes nothing.
FinishedPlan find_finished(const RunPlan& plan, const Workspace& workspace,
                           const Selection& selection = {});

/// What carrying out a plan needs beside the plan.
struct Execution {
    const Workspace& workspace;
    const Resources& resources;
    const Log& log;
    StopToken stop;
    Communicator& ranks;
};

/// Makes the selected work that `finished` (find_finished) lacks: shards are shared out over the
/// ranks by frames, other stages are made by all together. All ranks call it alike and return the
/// same, none before all are through: the workspace may be removed then. Throws Interrupted between
/// pieces of work, and UsageError when selected work needs inputs that are neither finished nor
/// selected.
FinishedPlan carry_out(const RunPlan& plan, FinishedPlan finished, const Selection& selection,
                       const Execution& execution);

/// Finished work as a message to other ranks, and back.
std::string pack_finished(const FinishedPlan& finished);
FinishedPlan unpack_finished(std::string bytes);

}  // namespace kinetome
