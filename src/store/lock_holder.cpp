#include "lock_holder.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "kinetome/base/quote.h"
#include "kinetome/store/json_text.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

std::string host_name() {
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string first_word_of(const fs::path& path) {
    std::string word;
    std::ifstream(path) >> word;
    return word;
}

std::string own_pid_namespace() {
    std::error_code ignored;
    return fs::read_symlink("/proc/self/ns/pid", ignored).string();
}

struct ProcessStatus {
    char state = 0;
    uint64_t started = 0;
};

/// From /proc/<pid>/stat (proc(5)); nothing when there is none to be read.
std::optional<ProcessStatus> status_of(pid_t process) {
    std::ifstream file(fmt::format("/proc/{}/stat", process));
    std::string line;
    if (!std::getline(file, line)) return std::nullopt;
    // The second field is the program's name in parentheses, and may hold anything.
    std::istringstream fields(line.substr(line.rfind(')') + 1));
    ProcessStatus status;
    fields >> status.state;
    constexpr int from_state_to_start = 19;
    std::string field;
    for (int i = 1; i < from_state_to_start; ++i) fields >> field;
    fields >> status.started;
    return fields ? std::optional(status) : std::nullopt;
}

Json write_job(const SlurmJob& job) {
    return {
        {"cluster", job.cluster}, {"job", job.id}, {"restarts", job.restarts}, {"user", job.user}};
}

SlurmJob parse_job(const Json& json) {
    return {.cluster = json.at("cluster"),
            .id = json.at("job"),
            .restarts = json.at("restarts"),
            .user = json.at("user")};
}

LockHolder read_holder(const Json& json) {
    LockHolder holder{.host = json.at("host"),
                      .boot = json.at("boot"),
                      .pid_namespace = json.at("pid_namespace"),
                      .process = json.at("process"),
                      .started = json.at("started"),
                      .since = json.at("since"),
                      .nonce = json.at("nonce"),
                      .job = {}};
    if (json.contains("slurm")) holder.job = parse_job(json.at("slurm"));
    return holder;
}

bool is_out_of_sight(const LockHolder& holder, const LockHolder& here) {
    return holder.host != here.host ||
           (holder.boot == here.boot && holder.pid_namespace != here.pid_namespace);
}

}  // namespace

std::string random_nonce() {
    std::random_device device;
    return fmt::format("{:08x}{:08x}", device(), device());
}

LockHolder this_process() {
    const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    const auto status = status_of(::getpid());
    return {.host = host_name(),
            .boot = first_word_of("/proc/sys/kernel/random/boot_id"),
            .pid_namespace = own_pid_namespace(),
            .process = ::getpid(),
            .started = status ? status->started : 0,
            .since = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now)),
            .nonce = random_nonce(),
            .job = this_slurm_job()};
}

std::string write_holder(const LockHolder& holder) {
    Json json{{"host", holder.host},
              {"boot", holder.boot},
              {"pid_namespace", holder.pid_namespace},
              {"process", holder.process},
              {"started", holder.started},
              {"since", holder.since},
              {"nonce", holder.nonce}};
    if (holder.job) json["slurm"] = write_job(*holder.job);
    return dump_json(json, -1);
}

std::optional<LockHolder> parse_holder(std::string_view text) {
    const char* const what = "the holder of a lock";
    try {
        return convert_json(parse_json(text, {}, what), {}, what, read_holder);
    } catch (const DamagedError&) {
        return std::nullopt;
    }
}

bool is_gone(const LockHolder& holder) {
    const LockHolder here = this_process();
    if (is_out_of_sight(holder, here)) {
        return holder.job && surely_over(*holder.job, here.job);
    }
    if (holder.boot != here.boot) return true;
    if (::kill(holder.process, 0) != 0 && errno == ESRCH) return true;
    const auto status = status_of(holder.process);
    if (!status) return false;  // exists, but hides from this user
    const bool ended = status->state == 'Z' || status->state == 'X';
    return ended || status->started != holder.started;
}

std::string describe(const LockHolder& holder) {
    const std::string job = holder.job ? fmt::format(" (Slurm job {})", holder.job->id) : "";
    return fmt::format("process {} on {}{} since {}", holder.process, path_for_message(holder.host),
                       job, path_for_message(holder.since));
}

}  // namespace kinetome
