// A store on disk: generations that never change, the one that is current, locks and leases
// (design §3, §4).
//
//   STORE/kinetome_store.json    what makes a folder a store, and its format
//   STORE/current                symbolic link to the current generation, switched last
//   STORE/generations/<id>/      files shared with other generations by hard links
//   STORE/scratch/               work in progress
//   STORE/locks/                 writer, record, slices/<name>, leases/<generation>.<nonce>,
//   removal.<id>
//
//   STORE/labels.csv             the user's own; never touched here
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kinetome/store/store_lock.h"

namespace kinetome {

class StoreDirectory {
  public:
    /// Opens a store. Throws StoreError when there is none, or when it is of a newer format.
    static StoreDirectory open(const std::filesystem::path& path);
    /// Opens it, or makes an empty one where nothing is (or labels.csv alone). Throws CreateError
    /// rather than scribble in a folder of another kind.
    static StoreDirectory open_or_create(const std::filesystem::path& path);

    /// Opens it; nothing where open_or_create would make one. Makes nothing. Throws as both do.
    static std::optional<StoreDirectory> find(const std::filesystem::path& path);

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path scratch() const { return path_ / "scratch"; }
    /// STORE/scratch/run: the run in progress; survives a kill.
    std::filesystem::path run_folder() const { return scratch() / "run"; }

    /// Id of the current generation; nothing when none was published. Throws StoreError when it is
    /// missing.
    std::optional<std::string> current() const;
    std::vector<std::string> generations() const;  ///< oldest first
    std::filesystem::path generation_folder(const std::string& id) const;
    /// Full id from an id, a unique beginning of one, or "current". Throws UsageError.
    std::string resolve_generation(const std::string& text) const;

    /// The one writer. Throws CreateError naming the holder when it, or a slice, is held by another
    /// live process. Removes what a killed writer left half made (not in the scratch folder).
    StoreLock lock_writer();
    /// A share of the run in progress (`slice-2-of-8`): excludes lock_writer and the same name.
    StoreLock lock_slice(const std::string& name);
    /// Who is at work for a slice other than `own`, in words; nothing when nobody is.
    std::optional<std::string> other_slice_at_work(const std::string& own) const;
    /// Held for the moment in which a slice looks at the record of the run and replaces it. Waits
    /// for the moments of others; throws CreateError when one takes more than a minute.
    StoreLock lock_record();
    /// A reader's lease on a generation, honoured by remove_old. Not held where none can be made (a
    /// store one may only read). Throws StoreError when the generation is gone.
    StoreLock lease(const std::string& generation) const;
    bool leased(const std::string& generation) const;

    /// One file of a new generation. It is linked from `source` (copied when links are refused), so
    /// that a kill before the end of publishing loses nothing there. Replace it, never write to it,
    /// afterwards.
    struct File {
        std::string name;
        std::filesystem::path source;
    };
    /// Builds generations/<id> under a private name, syncs and renames it, then switches `current`.
    /// At every moment of it `current` names a whole generation. `texts` are further files, by
    /// name. `copy` forbids links. Needs the writer's lock. Throws CreateError or StoreError; then
    /// the store is as it was.
    std::string publish(const std::vector<File>& files,
                        const std::map<std::string, std::string>& texts, bool copy);
    /// Removes all but the `keep` newest generations, never the current or a leased one; returns
    /// what was removed. Needs the writer's lock. Throws UsageError unless keep > 0.
    std::vector<std::string> remove_old(int keep);

  private:
    explicit StoreDirectory(std::filesystem::path path) : path_(std::move(path)) {}

    std::filesystem::path generations_folder() const { return path_ / "generations"; }
    std::filesystem::path locks_folder() const { return path_ / "locks"; }
    /// Held while a generation is being removed.
    std::filesystem::path removal_lock(const std::string& generation) const;
    std::string next_generation_id(const std::vector<File>& files,
                                   const std::map<std::string, std::string>& texts) const;
    void switch_current(const std::string& id) const;
    void remove_leftovers() const;
    void remove_stale_leases() const;

    std::filesystem::path path_;
};

}  // namespace kinetome
