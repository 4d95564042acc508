// The Slurm job that a process belongs to, and what Slurm says of it: of processes on other
// machines nobody else knows.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>

namespace kinetome {

struct SlurmJob {
    std::string cluster;
    uint64_t id = 0;        ///< each task of an array has one of its own
    uint64_t restarts = 0;  ///< how often it was requeued and began anew
    uid_t user = 0;

    bool operator==(const SlurmJob&) const = default;
};

/// From the environment; nothing outside of jobs.
std::optional<SlurmJob> this_slurm_job();

/// Whether a process that belonged to `job` surely ended, as far as a process of job `here`
/// (nothing: of none, where jobs are submitted) can tell: `here` is the same job begun anew, or
/// squeue says that the job is over. Never when in doubt.
bool surely_over(const SlurmJob& job, const std::optional<SlurmJob>& here);

}  // namespace kinetome
