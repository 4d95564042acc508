// The built program, and what it says.
#pragma once

#include <catch2/catch.hpp>
#include <chrono>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "support/command.h"
#include "texts.h"

inline Command program(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), KINETOME_PROGRAM);
    return {.words = std::move(arguments)};
}

inline CommandResult run_program(std::vector<std::string> arguments) {
    return run(program(std::move(arguments)));
}

/// What it wrote to standard output. The test fails here unless it answers `expected`.
inline CommandResult require_program(std::vector<std::string> arguments, int expected = 0) {
    CommandResult result = run_program(std::move(arguments));
    INFO(result.errors);
    REQUIRE(result.exit_code == expected);
    return result;
}

/// `kinetome reindex` with few clusters, so that tests are quick; `more` may say otherwise.
inline std::vector<std::string> reindex(const fs::path& corpus, const fs::path& store,
                                        const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"reindex", corpus.string(), "--store", store.string()};
    const auto give = [&](const std::string& option, const std::string& value) {
        for (const std::string& word : more) {
            if (word == option) return;
        }
        words.insert(words.end(), {option, value});
    };
    give("--clusters", "60");
    give("--shard-frames", "8192");
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// What a run said of each artifact.
struct RunLog {
    std::map<std::string, std::string> made;  ///< name → why
    std::set<std::string> reused;

    explicit RunLog(const std::string& errors) {
        for (const std::string& line : lines_of(errors)) {
            const std::string mark = " info ";
            const size_t at = line.find(mark);
            if (at == std::string::npos) continue;
            const std::string message = line.substr(at + mark.size());
            const std::string name = message.substr(0, message.find(':'));
            const std::string made_mark = ": to be made: ", reused_mark = ": reused from ";
            if (contains(message, made_mark)) {
                made[name] = message.substr(message.find(made_mark) + made_mark.size());
            } else if (contains(message, reused_mark)) {
                reused.insert(name);
            }
        }
    }

    std::set<std::string> names_made() const {
        std::set<std::string> names;
        for (const auto& [name, why] : made) names.insert(name);
        return names;
    }
};

/// Waits until something holds, such as a file being there. Fails the test after some minutes: what
/// is waited for may share its processors with the tests beside this one.
template <class Condition>
void wait_until(Condition condition) {
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(4);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > give_up) throw std::runtime_error("waited in vain");
        std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
}
