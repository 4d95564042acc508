#include "slurm_job.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include "kinetome/base/whole_number.h"

namespace kinetome {
namespace {

std::optional<uint64_t> number_variable(const char* name) {
    const char* text = std::getenv(name);
    return text ? whole_number<uint64_t>(text) : std::nullopt;
}

struct CommandAnswer {
    bool success = false;
    std::string text;  ///< standard output and standard error
};

/// One command line, all of whose words are the program's own.
CommandAnswer answer_of(const std::string& command) {
    CommandAnswer answer;
    std::FILE* output = ::popen((command + " 2>&1").c_str(), "re");
    if (!output) return answer;
    std::array<char, 4096> block;
    for (size_t got = 0; (got = std::fread(block.data(), 1, block.size(), output)) > 0;) {
        answer.text.append(block.data(), got);
    }
    answer.success = ::pclose(output) == 0;
    return answer;
}

bool is_final(std::string_view state) {
    constexpr std::array<std::string_view, 9> final_states = {
        "BOOT_FAIL", "CANCELLED",     "COMPLETED", "DEADLINE", "FAILED",
        "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED", "TIMEOUT"};
    return std::find(final_states.begin(), final_states.end(), state) != final_states.end();
}

/// squeue lists all tasks of an array whose number is asked for: those of another number do not
/// count.
bool lists_as_over(const std::string& text, uint64_t id) {
    bool found = false;
    std::istringstream lines(text);
    for (std::string number, state; lines >> number >> state;) {
        if (number != fmt::format("{}", id)) continue;
        if (!is_final(state)) return false;
        found = true;
    }
    return found;
}

/// "" where Slurm does not answer.
std::string cluster_of_this_machine() {
    std::istringstream lines(answer_of("timeout 20 scontrol show config").text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string name, equals, value;
        if (words >> name >> equals >> value && name == "ClusterName") return value;
    }
    return "";
}

}  // namespace

std::optional<SlurmJob> this_slurm_job() {
    const char* cluster = std::getenv("SLURM_CLUSTER_NAME");
    const auto id = number_variable("SLURM_JOB_ID");
    if (!cluster || !id) return std::nullopt;
    return SlurmJob{.cluster = cluster,
                    .id = *id,
                    .restarts = number_variable("SLURM_RESTART_COUNT").value_or(0),
                    .user = ::geteuid()};
}

bool surely_over(const SlurmJob& job, const std::optional<SlurmJob>& here) {
    if (job.cluster != (here ? here->cluster : cluster_of_this_machine())) return false;
    if (here && job.id == here->id) return job.restarts < here->restarts;
    const CommandAnswer squeue =
        answer_of(fmt::format("env -u SLURM_CLUSTERS timeout 20 squeue --noheader --states=all "
                              "--jobs={} --format='%A %T'",
                              job.id));
    if (squeue.success) return lists_as_over(squeue.text, job.id);
    // Forgotten, some minutes after its end. Jobs of other users may just be hidden from this one.
    return job.user == ::geteuid() &&
           squeue.text.find("Invalid job id specified") != std::string::npos;
}

}  // namespace kinetome
