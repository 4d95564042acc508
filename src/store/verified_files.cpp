#include "kinetome/store/verified_files.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <system_error>

#include "kinetome/base/error.h"

namespace kinetome {

void require_hash(const std::filesystem::path& path, const Digest& expected) {
    uint64_t bytes = 0;
    const Digest found = digest_file(path, &bytes);
    if (found == expected) return;
    throw StoreError(
        fmt::format("{} is damaged: its {} bytes have the hash {}, {} was recorded when it was "
                    "written; restore it from a copy, or reindex, which remakes it",
                    path.string(), bytes, found.hex(), expected.hex()));
}

void VerifiedFiles::require(const std::filesystem::path& path, const Digest& expected) {
    const Identity file = identify(path, expected);
    {
        const std::lock_guard lock(mutex_);
        if (verified_.contains(file)) return;
    }
    require_hash(path, expected);
    const std::lock_guard lock(mutex_);
    verified_.insert(file);
}

VerifiedFiles::Identity VerifiedFiles::identify(const std::filesystem::path& path,
                                                const Digest& hash) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) {
        throw StoreError("cannot open " + path.string() + ": " +
                         std::generic_category().message(errno));
    }
    return {.device = status.st_dev,
            .inode = status.st_ino,
            .bytes = status.st_size,
            .modified_seconds = status.st_mtim.tv_sec,
            .modified_nanoseconds = status.st_mtim.tv_nsec,
            .hash = hash};
}

}  // namespace kinetome
