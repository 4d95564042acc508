// kinetome: parses the command line, hands over to one command, answers with its exit code.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "command.h"
#include "kinetome/base/allocation.h"
#include "kinetome/base/architecture.h"
#include "kinetome/base/quote.h"
#include "kinetome/run/communicator.h"
#include "run_command.h"
#include "signals.h"

namespace kinetome::cli {
namespace {

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

Command reading(Command command) {
    command.reads_only = true;
    return command;
}

std::vector<Command> all_commands() {
    return {reindex_command(),
            ingest_command(),
            plan_command(),
            publish_command(),
            generate_command(),
            reading(info_command()),
            reading(verify_command()),
            reading(diff_command()),
            gc_command(),
            bundles_command(),
            reading(query_command()),
            reading(walk_command()),
            reading(label_command()),
            reading(estimate_command()),
            reading(compress_command()),
            reading(decompress_command()),
            reading(export_command()),
            reading(evaluate_command())};
}

/// Whether --log-format json is among the words, which may be no command line.
bool asks_for_json(std::span<char* const> words) {
    for (size_t i = 0; i < words.size(); ++i) {
        const std::string_view word = words[i], next = i + 1 < words.size() ? words[i + 1] : "";
        if (word == "--log-format=json" || (word == "--log-format" && next == "json")) return true;
    }
    return false;
}

/// Why no command could begin.
void tell(std::span<char* const> words, const std::string& message) {
    if (asks_for_json(words)) {
        Log({.format = LogFormat::json}).error("{}", message);
    } else {
        fmt::print(stderr, "kinetome: {}\n", message);
    }
}

/// Where two ranks were given different command lines; empty when none were.
std::string different_command_lines(const std::string& mine, Communicator& ranks) {
    const auto lines = ranks.gather_to_all(mine);
    for (size_t rank = 1; rank < lines.size(); ++rank) {
        if (lines[rank] == lines[0]) continue;
        return fmt::format(
            "the ranks of one run were given different commands (rank 0: {}; rank {}: {}): give "
            "all the same one, or start them apart from each other (srun --mpi=none)",
            lines[0], rank, lines[rank]);
    }
    return {};
}

ExitCode run_main(int argc, char** argv, const Launch& launch, StopToken stop,
                  Communicator& ranks) {
    /// All ranks refuse alike; rank 0 says why.
    const auto refuse = [&](const std::string& message) {
        if (ranks.is_root()) tell({argv, static_cast<size_t>(argc)}, message);
        return ExitCode::usage;
    };
    const std::string again = command_line(argc, argv);
    const std::string difference = different_command_lines(again, ranks);
    if (!difference.empty()) return refuse(difference);

    CLI::App app("Kinetome turns a folder of motion-capture takes into an index.", "kinetome");
    app.set_version_flag("--version", std::string("kinetome ") + KINETOME_VERSION);
    app.require_subcommand(1);
    app.failure_message(CLI::FailureMessage::help);
    app.footer("kinetome <command> --help tells a command's options, with an example.");

    CommonOptions common;
    std::vector<std::pair<CLI::App*, ChosenCommand>> choices;
    for (const Command& command : all_commands()) {
        CLI::App* sub = app.add_subcommand(command.name, command.summary);
        sub->footer("Example:\n  " + command.example);
        choices.emplace_back(sub, ChosenCommand{command.set_up(*sub), command.uses_ranks,
                                                command.reads_only, again});
        add_common_options(*sub, common);
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& asked) {  // --help, --version
        if (ranks.is_root()) app.exit(asked);
        return ExitCode::success;
    } catch (const CLI::ParseError& error) {
        const std::string first = argc > 1 ? argv[1] : "-";
        const bool known = std::any_of(choices.begin(), choices.end(), [&](const auto& choice) {
            return choice.first->get_name() == first;
        });
        return refuse(
            (known || first.starts_with('-') ? error.what()
                                             : "no command is called " + quote_for_message(first)) +
            "\nkinetome --help lists the commands, kinetome <command> --help its options.");
    } catch (const UsageError& error) {
        return refuse(error.what());
    }
    for (const auto& [sub, command] : choices) {
        if (sub->parsed()) return run_command(command, common, launch, stop, ranks);
    }
    return ExitCode::usage;
}

int start(int argc, char** argv) {
    try {
        require_build_architecture();
        keep_freed_memory();
        const StopToken stop = watch_signals();
        const Launch launch = launch_of(environment_of_this_process());
        const auto ranks = start_ranks(launch);
        return static_cast<int>(run_main(argc, argv, launch, stop, *ranks));
    } catch (const Error& error) {
        tell({argv, static_cast<size_t>(argc)}, error.what());
        return static_cast<int>(error.exit_code());
    }
}

}  // namespace
}  // namespace kinetome::cli

int main(int argc, char** argv) {
    return kinetome::cli::start(argc, argv);
}
