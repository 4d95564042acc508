// A command as a row: its name, what it does, an example, and how it is set up.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/error.h"
#include "kinetome/base/log.h"
#include "kinetome/base/resources.h"
#include "kinetome/base/stop.h"
#include "options.h"

namespace kinetome::cli {

/// What main hands to the command that was chosen.
struct Invocation {
    const CommonOptions& common;
    const Log& log;
    StopToken stop;
    Communicator& ranks;  ///< that carry it out: this one alone unless the command uses ranks
    NodeShare share;      ///< of this rank
    std::function<void()> require_joined;  ///< for commands that write: see run/launch.h

    Resources resources() const { return granted_resources(common.threads, common.memory, share); }
};

using Run = std::function<ExitCode(const Invocation&)>;

struct Command {
    std::string name;
    std::string summary;
    std::string example;
    /// Adds the command's options to `app` and returns what runs it.
    std::function<Run(CLI::App& app)> set_up;
    /// Every rank runs it, and rank 0's answer counts; else rank 0 runs it and the others wait.
    bool uses_ranks = false;
    /// It has no work to keep: asked to stop, it ends at once.
    bool reads_only = false;
};

Command reindex_command();
Command ingest_command();
Command publish_command();
Command plan_command();
Command generate_command();
Command info_command();
Command verify_command();
Command gc_command();
Command diff_command();
Command export_command();
Command evaluate_command();
Command estimate_command();
Command bundles_command();
Command walk_command();
Command label_command();
Command query_command();
Command compress_command();
Command decompress_command();

}  // namespace kinetome::cli
