// Runs the chosen command on the ranks there are, so that all answer with one exit code.
#pragma once

#include <string>

#include "command.h"
#include "kinetome/run/launch.h"

namespace kinetome::cli {

/// What a rank runs, and with what.
struct ChosenCommand {
    Run run;
    bool uses_ranks = false;
    bool reads_only = false;
    std::string command_line;  ///< as a shell would take it again
};

/// Every rank calls it. What went wrong on any rank is logged once, by rank 0.
ExitCode run_command(const ChosenCommand& command, const CommonOptions& common,
                     const Launch& launch, StopToken stop, Communicator& ranks);

}  // namespace kinetome::cli
