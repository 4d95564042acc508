// kinetome: parses the command line, hands over to one command, answers with its exit code.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <system_error>
#include <vector>

#include "command.h"
#include "kinetome/base/architecture.h"
#include "kinetome/base/quote.h"

namespace kinetome::cli {
namespace {

// A signal handler can reach nothing else: the one flag of the process.
std::atomic<bool> stop_requested{false};

extern "C" void request_stop(int) {
    stop_requested = true;
}

void watch_signals() {
    struct sigaction action = {};
    action.sa_handler = request_stop;
    action.sa_flags = SA_RESETHAND;  // the first signal asks, a second one ends
    sigaction(SIGTERM, &action, nullptr);
    sigaction(SIGINT, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is reported like a full disk
}

/// The command line as a shell would take it again.
std::string command_line(int argc, char** argv) {
    std::string line;
    for (int i = 0; i < argc; ++i) {
        const std::string word = argv[i];
        const bool plain = !word.empty() && word.find_first_not_of(
                                                "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTU"
                                                "VWXYZ0123456789-_./=:,+@%") == std::string::npos;
        std::string quoted = "'";
        for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
        line += (i ? " " : "") + (plain ? word : quoted + "'");
    }
    return line;
}

std::vector<Command> all_commands() {
    return {reindex_command(),  ingest_command(), plan_command(),   publish_command(),
            generate_command(), info_command(),   verify_command(), gc_command(),
            diff_command(),     export_command()};
}

ExitCode run_command(const Run& run, const CommonOptions& common, const std::string& again) {
    Log log;
    try {
        log = Log(common.log);
        const ExitCode code = run({common, log, StopToken(stop_requested)});
        // A reader that has seen enough (`| head`) is no error.
        if (std::fflush(stdout) != 0 && errno != EPIPE) {
            throw StoreError("standard output: cannot write: is its disk full?");
        }
        return code;
    } catch (const Interrupted&) {
        log.warning("stopped; finished work is kept. To resume: {}", again);
        return ExitCode::interrupted;
    } catch (const Error& error) {
        log.error("{}", error.what());
        return error.exit_code();
    } catch (const std::system_error& error) {  // of files and folders, or standard output
        log.error("{}", error.what());
        return ExitCode::io;
    } catch (const std::exception& error) {
        log.error("internal error: {}. Please report it with the command line: {}", error.what(),
                  again);
        return ExitCode::internal;
    }
}

ExitCode run_main(int argc, char** argv) {
    CLI::App app("Kinetome turns a folder of motion-capture takes into an index.", "kinetome");
    app.set_version_flag("--version", std::string("kinetome ") + KINETOME_VERSION);
    app.require_subcommand(1);
    app.failure_message(CLI::FailureMessage::help);
    app.footer("kinetome <command> --help tells a command's options, with an example.");

    CommonOptions common;
    std::vector<std::pair<CLI::App*, Run>> runs;
    for (const Command& command : all_commands()) {
        CLI::App* sub = app.add_subcommand(command.name, command.summary);
        sub->footer("Example:\n  " + command.example);
        runs.emplace_back(sub, command.set_up(*sub));
        add_common_options(*sub, common);
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& asked) {  // --help, --version
        app.exit(asked);
        return ExitCode::success;
    } catch (const CLI::ParseError& error) {
        const std::string first = argc > 1 ? argv[1] : "-";
        const bool known = std::any_of(runs.begin(), runs.end(), [&](const auto& command) {
            return command.first->get_name() == first;
        });
        fmt::print(stderr,
                   "kinetome: {}\nkinetome --help lists the commands, kinetome <command> "
                   "--help its options.\n",
                   known || first.starts_with('-')
                       ? error.what()
                       : "no command is called " + quote_for_message(first));
        return ExitCode::usage;
    } catch (const Error& error) {
        fmt::print(stderr, "kinetome: {}\n", error.what());
        return error.exit_code();
    }
    watch_signals();
    for (const auto& [sub, run] : runs) {
        if (sub->parsed()) return run_command(run, common, command_line(argc, argv));
    }
    return ExitCode::usage;
}

}  // namespace
}  // namespace kinetome::cli

int main(int argc, char** argv) {
    try {
        kinetome::require_build_architecture();
    } catch (const kinetome::Error& error) {
        std::fprintf(stderr, "kinetome: %s\n", error.what());
        return static_cast<int>(error.exit_code());
    }
    return static_cast<int>(kinetome::cli::run_main(argc, argv));
}
