// Who holds a lock, and whether that process still exists.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "slurm_job.h"

namespace kinetome {

struct LockHolder {
    std::string host;
    std::string boot;           ///< the kernel's id of the machine's last start
    std::string pid_namespace;  ///< process numbers mean something within it only
    pid_t process = 0;
    uint64_t started = 0;  ///< start of the process, in clock ticks since the machine's
    std::string since;     ///< UTC
    std::string nonce;     ///< no two locks ever taken have the same
    std::optional<SlurmJob> job;

    bool operator==(const LockHolder&) const = default;
};

/// 16 hexadecimal digits that nobody else has.
std::string random_nonce();

/// This process, now, with a new nonce.
LockHolder this_process();

/// One line of JSON, and back; nothing when the text is no such line.
std::string write_holder(const LockHolder& holder);
std::optional<LockHolder> parse_holder(std::string_view text);

/// Whether the holder surely exists no more. Of another machine nothing is sure, but what Slurm
/// tells of both jobs.
bool is_gone(const LockHolder& holder);

/// "process 123 on node7 (Slurm job 45) since 2026-11-22T02:15:00Z".
std::string describe(const LockHolder& holder);

}  // namespace kinetome
