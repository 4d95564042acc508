// What a run prints when it is done.
#pragma once

#include "kinetome/stages/reindex.h"

namespace kinetome::cli {

/// Counts, time by stage and memory on standard output; reasons of quarantined takes too.
void print_summary(const RunSummary& summary);

/// 3 when takes were quarantined, else 0.
ExitCode exit_code_of(const RunSummary& summary);

}  // namespace kinetome::cli
