// The main job and its parts: reindex, ingest and publish, from a folder of takes to a generation.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kinetome/base/log.h"
#include "kinetome/base/resources.h"
#include "kinetome/base/stop.h"
#include "kinetome/run/shard_plan.h"
#include "kinetome/stages/options.h"
#include "kinetome/stages/publication.h"

namespace kinetome {

struct ReindexRequest {
    std::filesystem::path corpus;
    std::filesystem::path store;
    ReindexOptions options;
    Resources resources;
    std::set<std::string> only;  ///< stages; empty: all
    bool copy = false;           ///< copy unchanged files instead of linking them
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

/// Everything, incrementally, and publishes.
RunSummary reindex(const ReindexRequest& request, const Log& log, const StopToken& stop);

struct IngestSummary {
    int64_t indexed = 0;
    int64_t quarantined = 0;
    int64_t frames = 0;
    std::vector<std::string> reasons;  ///< of the quarantined takes
};

/// The frames stage alone, of one slice or of all, without publishing.
IngestSummary ingest(const ReindexRequest& request, const std::optional<Slice>& slice,
                     const Log& log, const StopToken& stop);

/// Publishes what the run in progress has complete. Throws Error(nothing_usable) when there is
/// none.
RunSummary publish(const std::filesystem::path& store, const Resources& resources, bool copy,
                   const Log& log);

}  // namespace kinetome
