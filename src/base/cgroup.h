// The limits that control groups, version 1 or 2, put on a process.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace kinetome {

struct CgroupLimits {
    std::optional<int> threads;  ///< whole processors of the least quota, at least 1
    std::optional<uint64_t> memory_bytes;
};

/// The least limits of the process's groups and all groups above them. `root` is the folder that
/// holds proc/ and sys/fs/cgroup/.
CgroupLimits cgroup_limits(const std::filesystem::path& root);

}  // namespace kinetome
