#include "kinetome/store/free_space.h"

#include <fmt/format.h>
#include <sys/statvfs.h>

#include <cerrno>
#include <system_error>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"

namespace kinetome {
namespace fs = std::filesystem;

FreeSpace free_space(const fs::path& folder) {
    fs::path existing = fs::absolute(folder);
    while (!fs::exists(existing) && existing.has_relative_path()) existing = existing.parent_path();
    struct statvfs status {};
    if (::statvfs(existing.c_str(), &status) != 0) {
        throw StoreError(fmt::format("cannot tell the free space of {}: {}",
                                     path_for_message(existing.string()),
                                     std::generic_category().message(errno)));
    }
    FreeSpace free;
    free.bytes = static_cast<uint64_t>(status.f_bavail) * status.f_frsize;
    const bool counts_inodes = status.f_files > 0;  // Btrfs, for one, does not
    if (counts_inodes) free.inodes = status.f_favail;
    return free;
}

}  // namespace kinetome
