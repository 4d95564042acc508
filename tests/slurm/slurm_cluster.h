// The cluster that Slurm's tests run on: the throw-away one that KINETOME_TEST_MINI_SLURM names,
// never one that merely answers.
#pragma once

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "end_to_end/program.h"

inline std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

/// What a command of Slurm's answers, without the last line's end. Throws when it fails.
inline std::string ask(std::vector<std::string> words) {
    const CommandResult result = run({.words = words, .time_limit = 30});
    if (result.exit_code != 0) throw std::runtime_error(words.at(0) + ": " + result.errors);
    return result.output.substr(0, result.output.find_last_not_of('\n') + 1);
}

class SlurmCluster {
  public:
    /// Nothing, after a warning that is printed, unless KINETOME_TEST_SLURM is 1.
    static std::optional<SlurmCluster> find() {
        if (variable("KINETOME_TEST_SLURM") == "1") return SlurmCluster();
        WARN("SKIPPED: KINETOME_TEST_SLURM is not 1");
        return std::nullopt;
    }

    /// Of a list such as "n[1-2]".
    static std::string first_node(const std::string& nodes) {
        const std::string names = ask({"scontrol", "show", "hostnames", nodes});
        return names.substr(0, names.find('\n'));
    }
    /// Ends a node's daemon and all its processes, as when its power fails.
    void crash(const std::string& node) const {
        mini_slurm({"node-down", folder_, node});
        ask({"scontrol", "update", "nodename=" + node, "state=down", "reason=crash"});
    }
    void mend(const std::string& node) const {
        mini_slurm({"node-up", folder_, node});
        wait_until([&] { return !contains(ask({"sinfo", "-h", "-n", node, "-o", "%t"}), "down"); });
    }

  private:
    SlurmCluster() {
        if (folder_.empty()) throw std::runtime_error("KINETOME_TEST_MINI_SLURM is not set");
        use_environment();
    }
    /// From here on Slurm's commands, and those that they start, mean this cluster.
    void use_environment() const {
        const std::string variables =
            ask({"bash", "-c", "eval \"$(\"$0\" env \"$1\")\" && env -0", program, folder_});
        for (size_t first = 0; first < variables.size();) {
            const std::string line = variables.c_str() + first;
            const size_t equals = line.find('=');
            ::setenv(line.substr(0, equals).c_str(), line.substr(equals + 1).c_str(), 1);
            first += line.size() + 1;
        }
    }
    static void mini_slurm(std::vector<std::string> words) {
        words.insert(words.begin(), program);
        ask(words);
    }

    inline static const std::string program = KINETOME_SOURCE_DIR "/tests/support/mini-slurm";
    std::string folder_ = variable("KINETOME_TEST_MINI_SLURM");
};
