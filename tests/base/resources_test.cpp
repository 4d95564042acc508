#include "kinetome/base/resources.h"

#include <catch2/catch.hpp>
#include <map>
#include <thread>

#include "kinetome/base/error.h"
#include "support/temporary_folder.h"

using namespace kinetome;

namespace {

constexpr uint64_t gibibyte = uint64_t{1} << 30;

/// A machine of 64 processors and 256 GiB, 100 GiB of them free, without limits.
struct Machine {
    TemporaryFolder folder;
    std::map<std::string, std::string> environment;
    int affinity_threads = 64;
    NodeShare share;

    Machine() {
        folder.write("proc/meminfo",
                     "MemTotal:       268435456 kB\n"
                     "MemFree:         10000000 kB\n"
                     "MemAvailable:   104857600 kB\n");
    }
    Resources granted(std::optional<int> threads = {}, std::optional<uint64_t> bytes = {}) const {
        const auto variable = [this](const std::string& name) -> std::optional<std::string> {
            const auto found = environment.find(name);
            return found == environment.end() ? std::nullopt : std::optional(found->second);
        };
        return granted_resources(threads, bytes,
                                 {.affinity_threads = affinity_threads,
                                  .root = folder.path(),
                                  .environment = variable,
                                  .share = share});
    }
    void group(std::string_view lines) const { folder.write("proc/self/cgroup", lines); }
    void limit(const std::string& file, std::string_view text) const {
        folder.write("sys/fs/cgroup/" + file, text);
    }
};

}  // namespace

TEST_CASE(
    "without limits, the processors of the affinity and 80 % of the free memory are granted") {
    const Resources granted = Machine().granted();
    CHECK(granted.threads == 64);
    CHECK(granted.threads_source == "affinity");
    CHECK(granted.memory_bytes == 80 * gibibyte);
    CHECK(granted.memory_source == "80 % of free memory");
}

TEST_CASE("the least of affinity, cgroup and Slurm is granted") {
    Machine machine;
    machine.group("0::/slurm/job_7\n");
    machine.limit("slurm/job_7/cpu.max", "1600000 100000\n");
    machine.limit("slurm/job_7/memory.max", "34359738368\n");
    CHECK(machine.granted().threads == 16);
    CHECK(machine.granted().threads_source == "cgroup");
    CHECK(machine.granted().memory_bytes == 32 * gibibyte);
    CHECK(machine.granted().memory_source == "cgroup");

    machine.environment = {{"SLURM_CPUS_PER_TASK", "8"}, {"SLURM_MEM_PER_NODE", "16384"}};
    CHECK(machine.granted().threads == 8);
    CHECK(machine.granted().threads_source == "SLURM_CPUS_PER_TASK");
    CHECK(machine.granted().memory_bytes == 16 * gibibyte);
    CHECK(machine.granted().memory_source == "SLURM_MEM_PER_NODE");

    machine.environment = {{"SLURM_CPUS_PER_TASK", "32"}, {"SLURM_MEM_PER_NODE", "65536"}};
    CHECK(machine.granted().threads == 16);
    CHECK(machine.granted().memory_source == "cgroup");

    machine.affinity_threads = 4;
    CHECK(machine.granted().threads == 4);
    CHECK(machine.granted().threads_source == "affinity");
}

TEST_CASE("memory granted per processor is multiplied by the processors of the task") {
    Machine machine;
    machine.environment = {{"SLURM_CPUS_PER_TASK", "4"}, {"SLURM_MEM_PER_CPU", "2048"}};
    CHECK(machine.granted().memory_bytes == 8 * gibibyte);
    CHECK(machine.granted().memory_source == "SLURM_MEM_PER_CPU");
    // Using fewer threads than granted does not shrink the grant.
    CHECK(machine.granted(1).memory_bytes == 8 * gibibyte);
    machine.environment.erase("SLURM_CPUS_PER_TASK");
    machine.affinity_threads = 2;
    CHECK(machine.granted().memory_bytes == 4 * gibibyte);
}

TEST_CASE("ranks of one node divide its processors and its free memory") {
    Machine machine;
    machine.share = {.ranks = 4, .same_processors = 4};
    CHECK(machine.granted().threads == 16);
    CHECK(machine.granted().threads_source == "affinity, shared by 4 ranks");
    CHECK(machine.granted().memory_bytes == 20 * gibibyte);
    CHECK(machine.granted().memory_source == "80 % of free memory, shared by 4 ranks");
    // Bound apart, each has its processors to itself.
    machine.share = {.ranks = 4, .same_processors = 1};
    CHECK(machine.granted().threads == 64);
    CHECK(machine.granted().threads_source == "affinity");
    CHECK(machine.granted().memory_bytes == 20 * gibibyte);
}

TEST_CASE("ranks of one node divide the limits of their control group") {
    Machine machine;
    machine.share = {.ranks = 4, .same_processors = 1};
    machine.group("0::/\n");
    machine.limit("cpu.max", "800000 100000\n");
    machine.limit("memory.max", "34359738368\n");
    CHECK(machine.granted().threads == 2);
    CHECK(machine.granted().threads_source == "cgroup, shared by 4 ranks");
    CHECK(machine.granted().memory_bytes == 8 * gibibyte);
    CHECK(machine.granted().memory_source == "cgroup, shared by 4 ranks");
}

TEST_CASE("of what Slurm grants, ranks divide the memory of the node and nothing else") {
    Machine machine;
    machine.share = {.ranks = 4, .same_processors = 4};
    machine.environment = {{"SLURM_CPUS_PER_TASK", "8"}, {"SLURM_MEM_PER_NODE", "65536"}};
    CHECK(machine.granted().threads == 8);
    CHECK(machine.granted().threads_source == "SLURM_CPUS_PER_TASK");
    CHECK(machine.granted().memory_bytes == 16 * gibibyte);
    CHECK(machine.granted().memory_source == "SLURM_MEM_PER_NODE, shared by 4 ranks");

    machine.environment = {{"SLURM_CPUS_PER_TASK", "8"}, {"SLURM_MEM_PER_CPU", "2048"}};
    CHECK(machine.granted().memory_bytes == 16 * gibibyte);
    CHECK(machine.granted().memory_source == "SLURM_MEM_PER_CPU");
}

TEST_CASE("however many ranks share a processor, each keeps one thread") {
    Machine machine;
    machine.affinity_threads = 2;
    machine.share = {.ranks = 7, .same_processors = 7};
    machine.group("0::/\n");
    machine.limit("cpu.max", "200000 100000\n");
    CHECK(machine.granted().threads == 1);
}

TEST_CASE("values given to ranks are each rank's own") {
    Machine machine;
    machine.share = {.ranks = 4, .same_processors = 4};
    CHECK(machine.granted(100, 12345).threads == 100);
    CHECK(machine.granted(100, 12345).memory_bytes == 12345);
    CHECK(machine.granted(100, 12345).memory_source == "--memory");
}

TEST_CASE("variables that make no sense are ignored") {
    for (const char* garbage : {"", "many", "-4", "0", "4(x2)", " 4", "4 ", "4.5", "0x4", "+4",
                                "99999999999999999999999999", "18446744073709551615"}) {
        CAPTURE(garbage);
        Machine machine;
        for (const char* name :
             {"SLURM_CPUS_PER_TASK", "SLURM_MEM_PER_NODE", "SLURM_MEM_PER_CPU"}) {
            machine.environment[name] = garbage;
        }
        CHECK(machine.granted().threads == 64);
        CHECK(machine.granted().memory_bytes == 80 * gibibyte);
    }
}

TEST_CASE("a limit of any group above the process counts") {
    Machine machine;
    machine.group("0::/a/b/c\n");
    machine.limit("a/b/c/cpu.max", "max 100000\n");
    machine.limit("a/b/cpu.max", "1200000 100000\n");
    machine.limit("a/cpu.max", "600000 100000\n");
    machine.limit("a/memory.max", "1073741824\n");
    machine.limit("a/b/c/memory.max", "max\n");
    CHECK(machine.granted().threads == 6);
    CHECK(machine.granted().memory_bytes == gibibyte);
}

TEST_CASE("in a container whose group is not visible, the mount holds the limits") {
    for (const char* group : {"0::/docker/0123abcd\n", "0::/\n", "0::/../../elsewhere\n"}) {
        Machine machine;
        machine.group(group);
        machine.limit("cpu.max", "300000 100000\n");
        machine.limit("memory.max", "2147483648\n");
        CHECK(machine.granted().threads == 3);
        CHECK(machine.granted().memory_bytes == 2 * gibibyte);
    }
}

TEST_CASE("a part of a processor is rounded down, but one thread always remains") {
    Machine machine;
    machine.group("0::/\n");
    machine.limit("cpu.max", "350000 100000\n");
    CHECK(machine.granted().threads == 3);
    machine.limit("cpu.max", "50000 100000\n");
    CHECK(machine.granted().threads == 1);
}

TEST_CASE("version 1 control groups limit too, and their word for no limit is understood") {
    Machine machine;
    machine.group("12:pids:/job\n4:memory:/slurm/job_7\n3:cpu,cpuacct:/slurm/job_7\n0::/init\n");
    machine.limit("memory/memory.limit_in_bytes", "9223372036854771712\n");
    machine.limit("cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
    machine.limit("cpu,cpuacct/cpu.cfs_period_us", "100000\n");
    CHECK(machine.granted().threads == 64);
    CHECK(machine.granted().memory_source == "80 % of free memory");

    machine.limit("memory/slurm/job_7/memory.limit_in_bytes", "4294967296\n");
    machine.limit("cpu,cpuacct/slurm/job_7/cpu.cfs_quota_us", "500000\n");
    machine.limit("cpu,cpuacct/slurm/job_7/cpu.cfs_period_us", "100000\n");
    CHECK(machine.granted().threads == 5);
    CHECK(machine.granted().memory_bytes == 4 * gibibyte);
}

TEST_CASE("a limit above what the machine has is none") {
    Machine machine;
    machine.group("0::/\n");
    machine.limit("memory.max", "1099511627776\n");
    CHECK(machine.granted().memory_source == "80 % of free memory");
}

TEST_CASE("damaged or missing files grant what the others grant") {
    Machine machine;
    machine.group("nonsense\n:\n0::/a\n5:memory\n");
    machine.limit("a/cpu.max", "lots\n");
    machine.limit("a/memory.max", "-1\n");
    CHECK(machine.granted().threads == 64);
    CHECK(machine.granted().memory_bytes == 80 * gibibyte);
    machine.folder.write("proc/meminfo", "MemAvailable: plenty kB\n");
    CHECK(machine.granted().memory_bytes > 0);
    CHECK(machine.granted().memory_source == "assumed, as none is reported");
}

TEST_CASE("given values win over every grant and are named as their own source") {
    Machine machine;
    machine.environment = {{"SLURM_CPUS_PER_TASK", "8"}, {"SLURM_MEM_PER_NODE", "16384"}};
    const Resources granted = machine.granted(100, 12345);
    CHECK(granted.threads == 100);
    CHECK(granted.threads_source == "--threads");
    CHECK(granted.memory_bytes == 12345);
    CHECK(granted.memory_source == "--memory");
}

TEST_CASE("given values that are not positive are refused") {
    CHECK_THROWS_AS(granted_resources(0, {}), UsageError);
    CHECK_THROWS_AS(granted_resources(-1, {}), UsageError);
    CHECK_THROWS_AS(granted_resources({}, 0), UsageError);
}

TEST_CASE("this very process is granted something") {
    const Resources granted = granted_resources({}, {});
    CHECK(granted.threads >= 1);
    CHECK(granted.threads <= int(std::thread::hardware_concurrency()));
    CHECK(granted.memory_bytes > 0);
}

TEST_CASE("amounts of memory are read in binary units") {
    const std::map<std::string, uint64_t> table{
        {"65536", 65536},
        {"0", 0},
        {"1B", 1},
        {"1K", 1024},
        {"512M", 512 * (gibibyte >> 10)},
        {"8G", 8 * gibibyte},
        {"8g", 8 * gibibyte},
        {"8GB", 8 * gibibyte},
        {"8 GiB", 8 * gibibyte},
        {" 8G ", 8 * gibibyte},
        {"1.5GiB", 3 * gibibyte / 2},
        {"0.1K", 102},
        {"2T", 2048 * gibibyte},
        {"1p", gibibyte << 20},
        {"18446744073709551615", ~uint64_t{0}},
    };
    for (const auto& [text, bytes] : table) {
        CAPTURE(text);
        CHECK(parse_bytes(text) == bytes);
    }
}

TEST_CASE("text that is no amount of memory is refused, naming it") {
    for (const char* text : {"",
                             " ",
                             "G",
                             "-8G",
                             "+8G",
                             "8X",
                             "8GG",
                             "8Gi",
                             "8 G B",
                             "1.5",
                             "1.G",
                             ".5G",
                             "1..5G",
                             "1e9",
                             "0x10",
                             "8G,",
                             "18446744073709551616",
                             "16777216T",
                             "1.0000000000000000000G",
                             "nan",
                             "inf"}) {
        CAPTURE(text);
        CHECK_THROWS_AS(parse_bytes(text), UsageError);
        CHECK_THROWS_WITH(parse_bytes(text), Catch::StartsWith("'" + std::string(text) + "'"));
    }
}

TEST_CASE("amounts are described with their exact bytes") {
    CHECK(describe_bytes(0) == "0 bytes");
    CHECK(describe_bytes(1023) == "1023 bytes");
    CHECK(describe_bytes(8 * gibibyte) == "8.00 GiB (8589934592 bytes)");
    CHECK(describe_bytes(gibibyte - 1) == "1.00 GiB (1073741823 bytes)");
    CHECK(describe_bytes(3 * gibibyte / 2) == "1.50 GiB (1610612736 bytes)");
    CHECK(describe_bytes(~uint64_t{0}) == "16384.00 PiB (18446744073709551615 bytes)");
}

TEST_CASE("the peak of the resident size follows what is allocated and does not fall") {
    const uint64_t before = peak_resident_bytes();
    {
        std::string memory(size_t{96} << 20, 'x');
        volatile char use = memory[memory.size() / 2];
        static_cast<void>(use);
    }
    CHECK(peak_resident_bytes() >= before);
    CHECK(peak_resident_bytes() >= uint64_t{96} << 20);
}

TEST_CASE("processor seconds grow while working") {
    const double before = cpu_seconds();
    volatile uint64_t sum = 0;
    while (cpu_seconds() < before + 0.02) sum = sum + 1;
    CHECK(cpu_seconds() > before);
}
