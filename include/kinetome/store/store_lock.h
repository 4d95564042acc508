// A lock in a folder that several machines may share. It is a symbolic link whose target is a text
// that names the holder: one is made in one step or not at all, on every file system a store can
// live on (a store has such a link itself), without flock and without hard links.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>

namespace kinetome {

/// Held while its object lives, by the process that took it (a forked child does not hold it).
class StoreLock {
  public:
    /// Takes the lock at `path`, or takes it over when its holder is gone: a process of this
    /// machine that ended, one from before this machine's last start, or, on another machine, one
    /// whose Slurm job is over or was begun anew as the job of this process. Throws CreateError
    /// naming the holder when it lives or is out of sight.
    static StoreLock take(const std::filesystem::path& path);
    /// A lock that is not held, for a store one may only read.
    StoreLock() = default;
    ~StoreLock() { release(); }
    StoreLock(StoreLock&& other) noexcept;
    StoreLock& operator=(StoreLock&& other) noexcept;

    bool held() const { return !path_.empty(); }
    void release() noexcept;

  private:
    StoreLock(std::filesystem::path path, std::string content);

    std::filesystem::path path_;
    std::string content_;
    pid_t process_ = 0;
};

/// Who holds the lock at `path`, in words; nothing when nobody does or the holder is gone.
std::optional<std::string> live_holder(const std::filesystem::path& path);

}  // namespace kinetome
