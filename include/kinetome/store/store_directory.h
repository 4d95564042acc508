// A store on disk: generations that never change, the one that is current, locks and leases
// (design §3, §4).
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kinetome/base/digest.h"

namespace kinetome {

/// Held while its object lives: one file in STORE/locks naming host, process and start time.
/// A lock whose process is gone (same host) is stale and taken over.
class StoreLock {
  public:
    ~StoreLock();
    StoreLock(StoreLock&&) noexcept;
    StoreLock& operator=(StoreLock&&) noexcept;

  private:
    friend class StoreDirectory;
    struct State;
    explicit StoreLock(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

class StoreDirectory {
  public:
    /// Opens a store. Throws StoreError when there is none, or when it is of a newer format.
    static StoreDirectory open(const std::filesystem::path& path);
    /// Opens it, or makes an empty one. Throws CreateError.
    static StoreDirectory open_or_create(const std::filesystem::path& path);

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path scratch() const { return path_ / "scratch"; }
    /// STORE/scratch/run: the run in progress; survives a kill.
    std::filesystem::path run_folder() const { return scratch() / "run"; }

    /// Id of the current generation; nothing when none was published.
    std::optional<std::string> current() const;
    std::vector<std::string> generations() const;  ///< oldest first
    std::filesystem::path generation_folder(const std::string& id) const;
    /// Full id from an id, a unique beginning of one, or "current". Throws UsageError.
    std::string resolve_generation(const std::string& text) const;

    /// The one writer. Throws CreateError naming the holder when a live one exists.
    StoreLock lock_writer();
    /// A share of the run in progress (`slice-2-of-8`): excludes lock_writer and the same name.
    StoreLock lock_slice(const std::string& name);
    /// A reader's lease on a generation, honoured by gc.
    StoreLock lease(const std::string& generation) const;
    bool leased(const std::string& generation) const;

    /// One file of a new generation: moved from `made`, or linked (copied when links are refused
    /// or `copy` is set) from `reused`.
    struct File {
        std::string name;
        std::filesystem::path source;
        bool moved = false;  ///< false: hard link
    };
    /// Builds generations/<id> under a private name, syncs and renames it, then switches `current`.
    /// At every moment of it `current` names a whole generation.
    std::string publish(const std::vector<File>& files, const std::map<std::string, std::string>& texts,
                        bool copy);
    /// Removes all but the `keep` newest generations, never the current or a leased one; returns
    /// what was removed.
    std::vector<std::string> remove_old(int keep);

  private:
    explicit StoreDirectory(std::filesystem::path path) : path_(std::move(path)) {}
    std::filesystem::path path_;
};

/// Bytes that may still be written below a folder.
uint64_t free_bytes(const std::filesystem::path& folder);

}  // namespace kinetome
