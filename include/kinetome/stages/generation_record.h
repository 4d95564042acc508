// What a run for the takes of a published generation would be for, without reading them again.
#pragma once

#include "kinetome/run/generation.h"
#include "kinetome/stages/plan.h"

namespace kinetome {

/// Takes of the catalog and options in force. Files' sizes are not known: they are 0. Throws
/// DamagedError when the configuration is not what was published.
RunRecord record_of(const Generation& generation);

}  // namespace kinetome
