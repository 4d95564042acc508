#include "cgroup.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "kinetome/base/whole_number.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

/// Version 1 writes "no limit" as the largest multiple of a page.
constexpr uint64_t least_unlimited = uint64_t{1} << 62;

std::vector<std::string> words_of(const fs::path& path) {
    std::ifstream file(path);
    std::vector<std::string> words;
    for (std::string word; file >> word;) words.push_back(word);
    return words;
}

template <class Number>
void lower(std::optional<Number>& limit, Number value) {
    limit = std::min(limit.value_or(std::numeric_limits<Number>::max()), value);
}

void lower_threads(CgroupLimits& limits, const std::string& quota, const std::string& period) {
    const auto granted = whole_number<int64_t>(quota), of = whole_number<int64_t>(period);
    if (!granted || !of || *granted <= 0 || *of <= 0) return;  // "max" or -1: no limit
    const int64_t threads = std::clamp<int64_t>(*granted / *of, 1, std::numeric_limits<int>::max());
    lower(limits.threads, static_cast<int>(threads));
}

void lower_memory(CgroupLimits& limits, const std::string& bytes) {
    const auto granted = whole_number<uint64_t>(bytes);
    if (granted && *granted > 0 && *granted < least_unlimited) lower(limits.memory_bytes, *granted);
}

void read_version_2(const fs::path& group, CgroupLimits& limits) {
    if (const auto cpu = words_of(group / "cpu.max"); cpu.size() == 2) {
        lower_threads(limits, cpu[0], cpu[1]);
    }
    if (const auto memory = words_of(group / "memory.max"); memory.size() == 1) {
        lower_memory(limits, memory[0]);
    }
}

void read_version_1(const fs::path& group, CgroupLimits& limits) {
    const auto quota = words_of(group / "cpu.cfs_quota_us");
    const auto period = words_of(group / "cpu.cfs_period_us");
    if (quota.size() == 1 && period.size() == 1) lower_threads(limits, quota[0], period[0]);
    if (const auto memory = words_of(group / "memory.limit_in_bytes"); memory.size() == 1) {
        lower_memory(limits, memory[0]);
    }
}

/// From the group up to the mount. In a container the first groups may not be visible under the
/// mount, and the mount itself is the container's group.
template <class Read>
void walk_up(const fs::path& mount, const std::string& group, Read read, CgroupLimits& limits) {
    fs::path relative = fs::path(group).relative_path().lexically_normal();
    if (relative.begin() != relative.end() && *relative.begin() == "..") relative.clear();
    for (; !relative.empty(); relative = relative.parent_path()) read(mount / relative, limits);
    read(mount, limits);
}

}  // namespace

CgroupLimits cgroup_limits(const fs::path& root) {
    const fs::path mounts = root / "sys/fs/cgroup";
    CgroupLimits limits;
    std::ifstream groups(root / "proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {  // "number:controllers:group"
        const size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const std::string group = line.substr(second + 1);
        if (controllers.empty()) {
            walk_up(mounts, group, read_version_2, limits);
            walk_up(mounts / "unified", group, read_version_2, limits);
        } else {
            walk_up(mounts / controllers, group, read_version_1, limits);
        }
    }
    return limits;
}

}  // namespace kinetome
