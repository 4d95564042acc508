// What a stage is to the run: a typed row that says what it needs, what it makes and what its
// result depends on (design §4). The rows are in table.cpp.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/log.h"
#include "kinetome/base/resources.h"
#include "kinetome/base/stop.h"
#include "kinetome/run/ledger.h"
#include "kinetome/run/shard_plan.h"
#include "kinetome/run/workspace.h"
#include "kinetome/stages/options.h"
#include "kinetome/stages/survey.h"

namespace kinetome {

/// What every stage is given.
struct StageContext {
    const Survey& survey;
    const std::vector<Shard>& shards;
    const ReindexOptions& options;
    const Resources& resources;
    const Workspace& workspace;
    const Log& log;
    StopToken stop;
    Communicator* ranks = nullptr;  ///< that make the artifact together; null: this process alone

    /// How artifacts are written here.
    WriteOptions writing() const {
        return {parse_compression(options.frames.compression), resources.node_scratch};
    }
    Workers workers() const { return {resources.threads, ranks}; }
    /// Whether this rank writes the artifact; the others return an empty result.
    bool is_root() const { return workers().is_root(); }
    /// Throws RankFailure when another rank has failed: for long work of a rank's own.
    void check_ranks() const {
        if (ranks) ranks->check();
    }
};

/// One artifact to be made.
struct StageTask {
    std::filesystem::path output;  ///< final name in the run folder
    ArtifactHeader header;
    const Shard* shard = nullptr;  ///< null for stages that make one file
    /// Finished inputs: those of the same shard for a sharded stage, else, or when it reads all
    /// shards, of all in order.
    std::vector<FinishedWork> inputs;

    /// The inputs that a stage made.
    std::vector<const FinishedWork*> inputs_of(std::string_view stage) const;
};

struct StageResult {
    ArtifactRecord file;
    std::vector<ClipOutcome> clips;
};

struct StageRow {
    std::string name;                 ///< also the artifact's name
    std::vector<std::string> inputs;  ///< stages before it whose artifacts it reads
    bool sharded;  ///< one file a shard, each made by one rank, or one file made by all together
    bool reads_all_shards = false;  ///< of a sharded stage: each file is made of the whole corpus
    int format_version;             ///< raised when the same inputs give another result
    std::string description;
    StageResult (*make)(const StageContext&, const StageTask&);
    std::string switched_on_by = {};  ///< name of the option that asks for it; "": always made

    /// Whether a run with these options makes it.
    bool is_wanted(const ReindexOptions& options) const;
    std::string file_name(const Shard* shard) const;
};

/// All stages, inputs before those who need them.
const std::vector<StageRow>& stage_table();
/// Throws UsageError listing the names when there is none of that name.
const StageRow& stage_named(std::string_view name);

/// Throws UsageError for the name of no stage, and of one that the options leave out.
void require_wanted(const std::set<std::string>& stages, const ReindexOptions& options);

StageResult make_frames(const StageContext& context, const StageTask& task);
StageResult make_features(const StageContext& context, const StageTask& task);
StageResult make_pose_clusters(const StageContext& context, const StageTask& task);
StageResult make_motion_strings(const StageContext& context, const StageTask& task);
StageResult make_pose_hierarchy(const StageContext& context, const StageTask& task);
StageResult make_bundles(const StageContext& context, const StageTask& task);
StageResult make_bundle_graph(const StageContext& context, const StageTask& task);
StageResult make_neighbors(const StageContext& context, const StageTask& task);
StageResult make_corpus_neighbors(const StageContext& context, const StageTask& task);
StageResult make_segments(const StageContext& context, const StageTask& task);
StageResult make_signatures(const StageContext& context, const StageTask& task);
StageResult make_primitives(const StageContext& context, const StageTask& task);

}  // namespace kinetome
