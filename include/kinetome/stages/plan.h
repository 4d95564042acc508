// The plan of a run: which artifacts a corpus and options ask for, and under which keys.
#pragma once

#include <string>
#include <vector>

#include "kinetome/run/key.h"
#include "kinetome/run/shard_plan.h"
#include "kinetome/stages/options.h"
#include "kinetome/stages/stage.h"
#include "kinetome/stages/survey.h"

namespace kinetome {

/// One artifact of the plan.
struct PlannedWork {
    const StageRow* stage = nullptr;
    const Shard* shard = nullptr;  ///< null for stages that make one file
    std::string file_name;
    StageKey key;
};

/// Survey, shards and work in table order, shards in clip order. Not copied: work points into it.
struct RunPlan {
    RunPlan(Survey survey, const ReindexOptions& options);
    RunPlan(const RunPlan&) = delete;
    RunPlan& operator=(const RunPlan&) = delete;

    const Survey survey;
    const ReindexOptions options;
    const std::vector<Shard> shards;
    std::vector<PlannedWork> work;

    /// Positions in `work` of what a piece of work reads, in order: of the same shard for sharded
    /// stages, else, and for those that read all shards, of all.
    std::vector<size_t> inputs_of(const PlannedWork& work) const;
};

/// A survey and options as the text of STORE/scratch/run/run.json, which `publish` and the tasks
/// of an array start from.
std::string write_run_record(const Survey& survey, const ReindexOptions& options);

struct RunRecord {
    Survey survey;
    ReindexOptions options;
};
/// Throws StoreError naming `path`.
RunRecord parse_run_record(std::string_view json, const std::filesystem::path& path);

}  // namespace kinetome
