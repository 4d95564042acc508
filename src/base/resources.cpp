#include "kinetome/base/resources.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <memory>

#include "cgroup.h"
#include "kinetome/base/error.h"
#include "kinetome/base/whole_number.h"

namespace kinetome {
namespace {

/// Far above what a node has, far below what the kernel refuses half-way.
constexpr int most_threads = 4096;

constexpr uint64_t mebibyte = uint64_t{1} << 20;
/// When nothing says how much there is: what any machine of this century has.
constexpr uint64_t modest_memory = uint64_t{1} << 30;

std::optional<uint64_t> positive_variable(const GrantSources& sources, const std::string& name) {
    if (!sources.environment) return std::nullopt;
    const auto text = sources.environment(name);
    const auto value = text ? whole_number<uint64_t>(*text) : std::nullopt;
    return value && *value > 0 ? value : std::nullopt;
}

/// Bytes of a line "name:   123 kB" of a file of /proc.
std::optional<uint64_t> kilobyte_line(const std::filesystem::path& path, std::string_view name) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with(name)) continue;
        const size_t first = line.find_first_of("0123456789", name.size());
        if (first == std::string::npos) return std::nullopt;
        const size_t end = std::min(line.find(' ', first), line.size());
        const auto kilobytes =
            whole_number<uint64_t>(std::string_view(line).substr(first, end - first));
        if (!kilobytes) return std::nullopt;
        return *kilobytes * 1024;
    }
    return std::nullopt;
}

std::string shared_source(std::string_view source, int ranks) {
    return ranks > 1 ? fmt::format("{}, shared by {} ranks", source, ranks) : std::string(source);
}

void lower_threads(Resources& resources, uint64_t threads, std::string source) {
    if (threads >= static_cast<uint64_t>(resources.threads)) return;
    resources.threads = static_cast<int>(threads);
    resources.threads_source = std::move(source);
}

void lower_memory(Resources& resources, uint64_t bytes, std::string source) {
    if (resources.memory_bytes != 0 && bytes >= resources.memory_bytes) return;
    resources.memory_bytes = bytes;
    resources.memory_source = std::move(source);
}

void grant_threads(Resources& resources, const GrantSources& sources, const CgroupLimits& cgroup) {
    const NodeShare& share = sources.share;
    resources.threads = std::max(1, sources.affinity_threads / share.same_processors);
    resources.threads_source = shared_source("affinity", share.same_processors);
    if (cgroup.threads) {
        const int quota = std::max(1, *cgroup.threads / share.ranks);
        lower_threads(resources, static_cast<uint64_t>(quota),
                      shared_source("cgroup", share.ranks));
    }
    if (const auto slurm = positive_variable(sources, "SLURM_CPUS_PER_TASK")) {
        lower_threads(resources, *slurm, "SLURM_CPUS_PER_TASK");
    }
}

/// `processors`: how many of them SLURM_MEM_PER_CPU is granted for.
void grant_memory(Resources& resources, const GrantSources& sources, const CgroupLimits& cgroup,
                  uint64_t processors) {
    const auto installed = kilobyte_line(sources.root / "proc/meminfo", "MemTotal:");
    const auto grant = [&](uint64_t bytes, int ranks, std::string_view source) {
        if (installed && bytes > *installed) return;
        lower_memory(resources, std::max<uint64_t>(1, bytes / static_cast<uint64_t>(ranks)),
                     shared_source(source, ranks));
    };
    const auto grant_mebibytes = [&](uint64_t amount, uint64_t times, int ranks,
                                     std::string_view source) {
        const uint64_t most = std::numeric_limits<uint64_t>::max() / mebibyte / times;
        if (amount <= most) grant(amount * times * mebibyte, ranks, source);
    };
    const int ranks = sources.share.ranks;
    if (cgroup.memory_bytes) grant(*cgroup.memory_bytes, ranks, "cgroup");
    if (const auto slurm = positive_variable(sources, "SLURM_MEM_PER_NODE")) {
        grant_mebibytes(*slurm, 1, ranks, "SLURM_MEM_PER_NODE");
    }
    if (const auto slurm = positive_variable(sources, "SLURM_MEM_PER_CPU")) {
        grant_mebibytes(*slurm, processors, 1, "SLURM_MEM_PER_CPU");
    }
    if (resources.memory_bytes != 0) return;
    const auto available = kilobyte_line(sources.root / "proc/meminfo", "MemAvailable:");
    resources.memory_bytes =
        (available ? *available / 5 * 4 : modest_memory) / static_cast<uint64_t>(ranks);
    resources.memory_source =
        shared_source(available ? "80 % of free memory" : "assumed, as none is reported", ranks);
}

int affinity_of_this_process() {
    // A machine may have more processors than cpu_set_t has bits: ask with ever larger sets.
    for (int processors = CPU_SETSIZE; processors <= CPU_SETSIZE << 8; processors *= 2) {
        const std::unique_ptr<cpu_set_t, void (*)(cpu_set_t*)> set(
            CPU_ALLOC(processors), [](cpu_set_t* allocated) { CPU_FREE(allocated); });
        const size_t size = CPU_ALLOC_SIZE(processors);
        if (::sched_getaffinity(0, size, set.get()) == 0) return CPU_COUNT_S(size, set.get());
    }
    return 1;
}

}  // namespace

GrantSources GrantSources::of_this_process() {
    return {.affinity_threads = affinity_of_this_process(),
            .root = "/",
            .environment = environment_of_this_process(),
            .share = {}};
}

Resources granted_resources(std::optional<int> threads, std::optional<uint64_t> memory_bytes,
                            const NodeShare& share) {
    GrantSources sources = GrantSources::of_this_process();
    sources.share = share;
    return granted_resources(threads, memory_bytes, sources);
}

Resources granted_resources(std::optional<int> threads, std::optional<uint64_t> memory_bytes,
                            const GrantSources& sources) {
    if (threads && *threads <= 0) {
        throw UsageError(fmt::format("--threads {} is not positive: give at least 1", *threads));
    }
    if (threads && *threads > most_threads) {
        throw UsageError(fmt::format("--threads {} is more than {}, the most there can be",
                                     *threads, most_threads));
    }
    if (memory_bytes && *memory_bytes == 0) {
        throw UsageError("--memory 0 is not positive: give for example 8G");
    }
    const CgroupLimits cgroup = cgroup_limits(sources.root);
    Resources resources;
    grant_threads(resources, sources, cgroup);
    const uint64_t processors = positive_variable(sources, "SLURM_CPUS_PER_TASK")
                                    .value_or(static_cast<uint64_t>(resources.threads));
    grant_memory(resources, sources, cgroup, processors);
    if (threads) {
        resources.threads = *threads;
        resources.threads_source = "--threads";
    }
    if (memory_bytes) {
        resources.memory_bytes = *memory_bytes;
        resources.memory_source = "--memory";
    }
    return resources;
}

uint64_t resident_bytes() {
    return kilobyte_line("/proc/self/status", "VmRSS:").value_or(0);
}

uint64_t peak_resident_bytes() {
    if (const auto peak = kilobyte_line("/proc/self/status", "VmHWM:")) return *peak;
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

double cpu_seconds() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace kinetome
