// What this process was granted: threads and bytes of the job, never of the node.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "kinetome/base/environment.h"

namespace kinetome {

struct Resources {
    int threads = 1;
    uint64_t memory_bytes = 0;
    std::string threads_source;  ///< e.g. "affinity", "cgroup", "SLURM_CPUS_PER_TASK", "--threads"
    std::string memory_source;   ///< e.g. "cgroup", "SLURM_MEM_PER_NODE, shared by 4 ranks"
    /// Folder on this machine's own disk where files may be put together; "" none. Never guessed.
    std::filesystem::path node_scratch{};
};

/// The ranks of a run that share what a node grants, this one among them.
struct NodeShare {
    int ranks = 1;  ///< on the node: they share its memory and the quota of processors
    /// Of those, the ones that may run on the same processors as this one.
    int same_processors = 1;
};

/// Threads: min(affinity, cgroup, SLURM_CPUS_PER_TASK); bytes: min(cgroup, SLURM_MEM_*), else 80 %
/// of what is free. What several ranks share is divided among them; what Slurm grants each task is
/// not. A given value wins. Throws UsageError for values that are not positive.
Resources granted_resources(std::optional<int> threads, std::optional<uint64_t> memory_bytes,
                            const NodeShare& share = {});

/// Where a grant is written down.
struct GrantSources {
    int affinity_threads = 1;          ///< processors the process may run on
    std::filesystem::path root = "/";  ///< the folder that holds proc/ and sys/fs/cgroup/
    Environment environment;
    NodeShare share;

    static GrantSources of_this_process();
};

/// The same, from the sources given. What cannot be read or understood grants nothing and takes
/// nothing away.
Resources granted_resources(std::optional<int> threads, std::optional<uint64_t> memory_bytes,
                            const GrantSources& sources);

/// "8G", "512M", "1.5GiB", "65536": binary units. Throws UsageError naming the text.
uint64_t parse_bytes(std::string_view text);

/// "8.00 GiB (8589934592 bytes)".
std::string describe_bytes(uint64_t bytes);

/// Resident size of this process now (VmRSS).
uint64_t resident_bytes();

/// Highest resident size of this process so far (VmHWM).
uint64_t peak_resident_bytes();

/// Processor seconds of this process so far, all threads.
double cpu_seconds();

}  // namespace kinetome
