// A store at work: its last generation, the work in progress, and the record of what the run is
// for, which its parts share.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "kinetome/base/log.h"
#include "kinetome/run/workspace.h"
#include "kinetome/stages/plan.h"
#include "kinetome/stages/reindex.h"

namespace kinetome {

/// Its log also writes to a file of the run, of its own when it is a slice of the run.
class RunInProgress {
  public:
    RunInProgress(const StoreDirectory& store, const Log& terminal, const std::string& slice = "");
    RunInProgress(const RunInProgress&) = delete;
    RunInProgress& operator=(const RunInProgress&) = delete;

    const Generation* last() const { return last_ ? &*last_ : nullptr; }
    Workspace& workspace() { return *workspace_; }
    const Log& log() const { return log_; }
    std::filesystem::path record_file() const { return workspace_->folder() / "run.json"; }

    /// What the run was entered for; nothing when there is none, or none that can be read.
    std::optional<RunRecord> opened() const;
    /// Leaves the record that `publish` and joining parts start from. `slice` is the lock held: ""
    /// for the writer's. Throws CreateError rather than change the record that other slices are at
    /// work for.
    void enter(const RunRecord& record, const std::string& slice);

  private:
    void open_last(const std::string& id);

    StoreDirectory store_;
    VerifiedFiles verified_;
    std::optional<Generation> last_;
    std::optional<Workspace> workspace_;
    Log log_;
};

/// Whether both ask for the same work: takes, their contents, options.
bool same_work(const RunRecord& a, const RunRecord& b);

/// The record of the run that was opened. Throws Error(nothing_usable) when none is, and UsageError
/// naming what the request has otherwise.
RunRecord joined_record(const ReindexRequest& request, const StoreDirectory& store);

}  // namespace kinetome
