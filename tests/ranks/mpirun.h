// Programs as the ranks of an MPI job.
#pragma once

#include <string>
#include <vector>

#include "support/command.h"

/// mpirun of `count` ranks, also as root and on fewer processors. It ends what hangs.
inline Command as_ranks(int count, std::vector<std::string> program) {
    std::vector<std::string> words = {
        "env", "OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1", KINETOME_MPIRUN,
        "--oversubscribe", "--bind-to", "none",
        // No network: the ranks are on this machine.
        "--mca", "btl", "self,vader", "--timeout", "90", "-n", std::to_string(count)};
    words.insert(words.end(), program.begin(), program.end());
    return {.words = std::move(words)};
}
