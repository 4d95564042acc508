#include "run_command.h"

#include <fmt/format.h>

#include <exception>
#include <system_error>

#include "kinetome/run/node_share.h"
#include "signals.h"
#include "write_text.h"

namespace kinetome::cli {
namespace {

struct Failure {
    ExitCode code;
    std::string message;
};

/// What the exception being handled means to the user.
Failure current_failure(const std::string& command_line) {
    try {
        throw;
    } catch (const Error& error) {
        return {error.exit_code(), error.what()};
    } catch (const std::system_error& error) {  // of files and folders, or standard output
        return {ExitCode::io, error.what()};
    } catch (const std::exception& error) {
        return {ExitCode::internal,
                fmt::format("internal error: {}. Please report it with the command line: {}",
                            error.what(), command_line)};
    }
}

void log_failure(const Failure& failure, const ChosenCommand& command, const Communicator& ranks,
                 const Log& log) {
    if (failure.code == ExitCode::interrupted) {
        log.warning("stopped; finished work is kept. To resume{}: {}",
                    ranks.size() > 1 ? ", on any number of ranks" : "", command.command_line);
    } else {
        log.error("{}", failure.message);
    }
}

/// Of ranks other than 0 only what rank 0 cannot tell is shown.
LogOptions log_options(const LogOptions& given, const Communicator& ranks) {
    LogOptions options = given;
    if (ranks.is_root()) return options;
    options.quiet = true;
    options.prefix = fmt::format("rank {}: ", ranks.rank());
    if (!options.file.empty()) options.file += fmt::format(".rank{}", ranks.rank());
    return options;
}

/// `log` speaks on standard error before a file is added, which may fail.
void open_log(const LogOptions& options, Log& log) {
    LogOptions terminal = options;
    terminal.file.clear();
    log = Log(terminal);
    if (!options.file.empty()) log.add_file(options.file);
}

/// As write_text and flush_output have it, for what is printed directly.
ExitCode run_to_the_end(const ChosenCommand& command, const Invocation& invocation) {
    try {
        const ExitCode code = command.run(invocation);
        flush_output();
        return code;
    } catch (const std::system_error& error) {
        if (error.code() != std::errc::broken_pipe) throw;
        return ExitCode::success;
    }
}

}  // namespace

ExitCode run_command(const ChosenCommand& command, const CommonOptions& common,
                     const Launch& launch, StopToken stop, Communicator& ranks) {
    Log log;
    try {
        if (command.reads_only) stop_watching_signals();
        ExitCode code = ExitCode::success;
        if (command.uses_ranks || ranks.is_root()) {
            open_log(log_options(common.log, ranks), log);
            SerialCommunicator alone;
            Communicator& carriers = command.uses_ranks ? ranks : alone;
            code = run_to_the_end(command, {common, log, stop, carriers, node_share(carriers),
                                            [&] { require_joined(launch, ranks); }});
        }
        return static_cast<ExitCode>(
            std::stoi(ranks.broadcast(std::to_string(static_cast<int>(code)))));
    } catch (const RankFailure& failure) {
        if (ranks.is_root()) {
            log_failure({failure.exit_code(), failure.what()}, command, ranks, log);
        }
        return failure.exit_code();
    } catch (...) {
        const Failure failure = current_failure(command.command_line);
        if (ranks.is_root()) log_failure(failure, command, ranks, log);
        return ranks.fail(failure.code, failure.message);
    }
}

}  // namespace kinetome::cli
