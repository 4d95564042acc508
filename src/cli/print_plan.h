// What `plan` prints.
#pragma once

#include "kinetome/stages/run_estimate.h"

namespace kinetome::cli {

/// For people.
void print_plan_text(const RunEstimate& estimate);
/// Everything, under the names of docs/operations.md.
void print_plan_json(const RunEstimate& estimate);
/// What a job script asks for, with margins: name=value, values of digits and ':' alone.
void print_plan_shell(const RunEstimate& estimate);

}  // namespace kinetome::cli
