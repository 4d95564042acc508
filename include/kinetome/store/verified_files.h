// The files whose bytes were found to be what the ledger says, so that each is hashed once.
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <set>

#include "kinetome/base/digest.h"

namespace kinetome {

/// Throws StoreError naming the file unless its bytes have the hash `expected`.
void require_hash(const std::filesystem::path& path, const Digest& expected);

/// Thread-safe; one object serves a whole run. A file replaced or written to since it was hashed
/// (another inode, size or time) is hashed again.
class VerifiedFiles {
  public:
    /// require_hash, unless that was done before.
    void require(const std::filesystem::path& path, const Digest& expected);

  private:
    struct Identity {
        uint64_t device = 0;
        uint64_t inode = 0;
        int64_t bytes = 0;
        int64_t modified_seconds = 0;
        int64_t modified_nanoseconds = 0;
        Digest hash;
        auto operator<=>(const Identity&) const = default;
    };
    static Identity identify(const std::filesystem::path& path, const Digest& hash);

    std::mutex mutex_;
    std::set<Identity> verified_;
};

}  // namespace kinetome
