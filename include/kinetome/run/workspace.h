// Where a run keeps its finished work until it is published, and where it finds what an earlier
// run, or the last generation, already made (design §4).
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "kinetome/run/generation.h"
#include "kinetome/run/ledger.h"
#include "kinetome/store/store_directory.h"

namespace kinetome {

/// A finished artifact and where its file is now.
struct FinishedWork {
    Receipt receipt;
    std::filesystem::path path;
    bool from_generation = false;  ///< else made by this run, or by the run that it resumes
};

/// Receipts are files of their own, one an artifact, so that array tasks can work side by side
/// and a kill loses nothing that was finished.
class Workspace {
  public:
    enum class Purpose {
        work,  ///< makes the run folder
        look,  ///< makes nothing: only to find what is finished
    };

    /// `last` is the generation to reuse from, or null; it and `verified` outlive the workspace.
    Workspace(StoreDirectory store, const Generation* last, VerifiedFiles& verified,
              Purpose purpose = Purpose::work);

    const StoreDirectory& store() const { return store_; }
    const Generation* last() const { return last_; }
    const std::filesystem::path& folder() const { return folder_; }

    /// Finished work under that file name and key whose file still has its hash.
    std::optional<FinishedWork> find(const std::string& file_name, const StageKey& key) const;
    /// Why find() found nothing, for the log: "is new", "input frames changed", "is damaged".
    std::string why_missing(const std::string& file_name, const StageKey& key) const;

    ArtifactReader open(const FinishedWork& work) const;

    /// Enters an artifact that was closed in folder().
    FinishedWork commit(Receipt receipt) const;

    /// Removes temporary files of killed writers. Call only while holding the writer lock.
    void remove_leftovers() const;
    /// Removes the run folder: its work has been published.
    void remove() const;

  private:
    bool is_intact(const FinishedWork& work) const;
    std::optional<FinishedWork> in_run(const std::string& file_name) const;
    std::optional<FinishedWork> in_generation(const std::string& file_name) const;

    StoreDirectory store_;
    const Generation* last_;
    VerifiedFiles* verified_;
    std::filesystem::path folder_;
};

}  // namespace kinetome
