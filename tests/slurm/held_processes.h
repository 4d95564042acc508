// Processes of the program on a store, held where they are: what a test does to a run at work must
// not depend on how fast the run is.
#pragma once

#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "end_to_end/program.h"

/// Processes of `kinetome COMMAND` that work on a store.
inline std::vector<pid_t> processes_on(const fs::path& store, const std::string& command) {
    std::vector<pid_t> found;
    for (const auto& entry : fs::directory_iterator("/proc")) {
        const std::string name = entry.path().filename().string();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        std::ifstream file(entry.path() / "cmdline", std::ios::binary);
        std::vector<std::string> words;  // none where the process has just ended
        for (std::string word; std::getline(file, word, '\0');) words.push_back(word);
        if (words.size() > 1 && words[0].ends_with("kinetome") && words[1] == command &&
            std::find(words.begin(), words.end(), store.string()) != words.end()) {
            found.push_back(std::stoi(name));
        }
    }
    return found;
}

/// Stopped until they are let go, at the latest with this object.
class HeldProcesses {
  public:
    explicit HeldProcesses(std::vector<pid_t> ids) : ids_(std::move(ids)) {
        for (const pid_t id : ids_) ::kill(id, SIGSTOP);
        wait_until([&] { return all([](pid_t id) { return is_stopped(id) || has_ended(id); }); });
    }
    ~HeldProcesses() { let_go(); }
    HeldProcesses(const HeldProcesses&) = delete;
    HeldProcesses& operator=(const HeldProcesses&) = delete;

    const std::vector<pid_t>& ids() const { return ids_; }

    void let_go() const {
        for (const pid_t id : ids_) ::kill(id, SIGCONT);
    }
    /// Lets them go when the signal is what they meet first. Whoever sent it may have done that.
    void let_go_into(int signal) const {
        wait_until([&] {
            return all([&](pid_t id) { return is_pending(id, signal) || !is_stopped(id); });
        });
        let_go();
    }

  private:
    template <class Condition>
    bool all(Condition condition) const {
        return std::all_of(ids_.begin(), ids_.end(), condition);
    }
    /// Of /proc/ID/status; nothing when there is no such process.
    static std::string status(pid_t id, const std::string& field) {
        std::ifstream file("/proc/" + std::to_string(id) + "/status");
        for (std::string line; std::getline(file, line);) {
            if (line.starts_with(field + ":\t")) return line.substr(field.size() + 2);
        }
        return "";
    }
    static bool is_stopped(pid_t id) { return status(id, "State").starts_with("T"); }
    static bool has_ended(pid_t id) {
        const std::string state = status(id, "State");
        return state.empty() || state.starts_with("Z") || state.starts_with("X");
    }
    static bool is_pending(pid_t id, int signal) {
        const std::string signals = status(id, "ShdPnd");
        return !signals.empty() && (std::stoull(signals, nullptr, 16) >> (signal - 1) & 1);
    }

    std::vector<pid_t> ids_;
};
