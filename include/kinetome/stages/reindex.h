// The main job and its parts: reindex, ingest and publish, from a folder of takes to a generation.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/log.h"
#include "kinetome/base/resources.h"
#include "kinetome/base/stop.h"
#include "kinetome/run/shard_plan.h"
#include "kinetome/stages/options.h"
#include "kinetome/stages/plan.h"
#include "kinetome/stages/publication.h"

namespace kinetome {

struct ReindexRequest {
    std::filesystem::path corpus;
    std::filesystem::path store;
    ReindexOptions options;
    Resources resources;
    std::set<std::string> only;  ///< stages; empty: all
    bool copy = false;           ///< copy unchanged files instead of linking them
    bool publish = true;         ///< else everything but publishing
    /// Take part in the run that open_run opened: takes and options are its, not surveyed again and
    /// not those of `options`.
    bool join = false;
    std::map<std::string, std::string> given_options;  ///< what the joined run must agree with
    Communicator* ranks = nullptr;  ///< that carry out the run together; null: this process alone
};

/// One stage of a run, for the summary.
struct StageSummary {
    std::string name;
    int made = 0;
    int reused = 0;
    Cost cost;           ///< of what was made now
    uint64_t bytes = 0;  ///< of all its files
};

struct RunSummary {
    Publication publication;
    std::vector<StageSummary> stages;
    Cost cost;  ///< of the whole run
};

/// Surveys the corpus, checks that the disk has room, and leaves the record that others join:
/// `ingest` in slices, `reindex`, `publish`. Finished work of an earlier run stays usable.
RunRecord open_run(const ReindexRequest& request, const Log& log, const StopToken& stop);

/// Everything, incrementally, and publishes. Every rank calls it; rank 0 holds the store, publishes
/// and has the summary, the others return an empty one. A joined run throws Error(nothing_usable)
/// when none is open, and UsageError when the request is not what it was opened for.
RunSummary reindex(const ReindexRequest& request, const Log& log, const StopToken& stop);

struct RemakeRequest {
    std::filesystem::path store;
    std::set<std::string> stages;                ///< whose options may be given
    std::map<std::string, std::string> options;  ///< name and value; the others stay as they are
    Resources resources;
    bool copy = false;  ///< copy unchanged files instead of linking them
};

/// Stages of the current generation again, with other options, and all that is made of them; takes
/// are not read. Publishes. Throws UsageError when what those stages need is not there as this
/// version makes it, and CreateError while a run for something else is in progress.
RunSummary remake(const RemakeRequest& request, const Log& log, const StopToken& stop);

struct IngestSummary {
    int64_t indexed = 0;
    int64_t quarantined = 0;
    int64_t frames = 0;
    std::vector<std::string> reasons;  ///< of the quarantined takes
};

/// The frames stage alone, of one slice or of all, without publishing. Slices that are not joined
/// throw CreateError rather than change the record of a run that other slices are at work for.
IngestSummary ingest(const ReindexRequest& request, const std::optional<Slice>& slice,
                     const Log& log, const StopToken& stop);

/// Publishes what the run in progress has complete. Throws Error(nothing_usable) when there is
/// none.
RunSummary publish(const std::filesystem::path& store, const Resources& resources, bool copy,
                   const Log& log);

}  // namespace kinetome
