// From finished work to a generation that readers see, under the publish laws (design §4).
#pragma once

#include <optional>
#include <string>

#include "kinetome/base/log.h"
#include "kinetome/stages/execution.h"
#include "kinetome/stages/plan.h"

namespace kinetome {

/// What was published.
struct Publication {
    std::string generation;   ///< id of the new generation, or of the current one when up to date;
                              ///< "" while it is not published
    bool up_to_date = false;  ///< nothing changed: no new generation was made
    Catalog catalog;
    Ledger ledger;
    int64_t reused = 0;  ///< clips as in the last generation
    int64_t added = 0;
    int64_t changed = 0;
};

/// The catalog that a plan's finished frames make.
Catalog make_catalog(const RunPlan& plan, const FinishedPlan& finished, const Generation* last);

/// What publish_plan would publish: every stage whose work is complete and whose inputs are
/// published too; a stage that is not is left out, with a line in the log. Throws
/// Error(nothing_usable) when frames are incomplete or no clip was indexed, and Error(internal)
/// when a publish law does not hold.
Publication prepare_publication(const RunPlan& plan, const FinishedPlan& finished,
                                const Generation* last, const Log& log);

/// Prepares and publishes. The logs of the run folder become log.txt of the generation.
Publication publish_plan(const RunPlan& plan, const FinishedPlan& finished, Workspace& workspace,
                         bool copy, const Log& log);

}  // namespace kinetome
