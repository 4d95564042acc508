// Every stage of the program. Read this first.
#include <fmt/format.h>

#include <algorithm>

#include "kinetome/base/error.h"
#include "kinetome/stages/stage.h"

namespace kinetome {

const std::vector<StageRow>& stage_table() {
    static const std::vector<StageRow> table = {
        {.name = "frames",
         .inputs = {},
         .sharded = true,
         .format_version = 1,
         .description = "takes parsed to degrees of freedom and joint positions",
         .make = make_frames},
        {.name = "features",
         .inputs = {"frames"},
         .sharded = true,
         .format_version = 1,
         .description = "pose vectors (S1), effector features (S3), marker sets (S2)",
         .make = make_features},
        {.name = "pose_clusters",
         .inputs = {"features"},
         .sharded = false,
         .format_version = 1,
         .description = "principal components and a mixture of isotropic Gaussians (S1 §3.2)",
         .make = make_pose_clusters},
        {.name = "motion_strings",
         .inputs = {"features", "pose_clusters"},
         .sharded = false,
         .format_version = 1,
         .description = "letters, accessibility, τ and λ (S1 §3.2, §3.6)",
         .make = make_motion_strings},
        {.name = "pose_hierarchy",
         .inputs = {"features"},
         .sharded = false,
         .format_version = 2,
         .description = "principal markers and a tree of local linear models (S2 §3, §4)",
         .make = make_pose_hierarchy},
        {.name = "bundles",
         .inputs = {"features", "pose_clusters", "motion_strings"},
         .sharded = false,
         .format_version = 1,
         .description = "similar motions brought together, with their frames (S1 §3.3–3.5)",
         .make = make_bundles},
        {.name = "bundle_graph",
         .inputs = {"frames", "bundles"},
         .sharded = false,
         .format_version = 5,
         .description = "which motion bundles follow each other, which are the same (S1 §4)",
         .make = make_bundle_graph},
        {.name = "signatures",
         .inputs = {"features", "pose_hierarchy"},
         .sharded = false,
         .format_version = 3,
         .description = "takes as the leaves they pass through, and their index (S2 §5.3)",
         .make = make_signatures},
        {.name = "neighbors",
         .inputs = {"features"},
         .sharded = true,
         .format_version = 1,
         .description = "the neighbourhood graph of each take (S3 §3)",
         .make = make_neighbors},
        {.name = "segments",
         .inputs = {"features", "neighbors"},
         .sharded = false,
         .format_version = 2,
         .description = "takes cut into activities and transitions (S3 §3.1)",
         .make = make_segments},
        {.name = "primitives",
         .inputs = {"features", "neighbors", "segments"},
         .sharded = false,
         .format_version = 3,
         .description = "executions of movements, and which are the same (S3 §3.2, §4)",
         .make = make_primitives},
        {.name = "corpus_neighbors",
         .inputs = {"features", "neighbors"},
         .sharded = true,
         .reads_all_shards = true,
         .format_version = 1,
         .description = "the neighbourhood graph of all takes together (S3 §3)",
         .make = make_corpus_neighbors,
         .switched_on_by = "corpus-graph"},
    };
    return table;
}

const StageRow& stage_named(std::string_view name) {
    std::vector<std::string> names;
    for (const StageRow& row : stage_table()) {
        if (row.name == name) return row;
        names.push_back(row.name);
    }
    throw UsageError(
        fmt::format("no stage is called '{}'; there are {}", name, fmt::join(names, ", ")));
}

void require_wanted(const std::set<std::string>& stages, const ReindexOptions& options) {
    for (const std::string& name : stages) {
        const StageRow& stage = stage_named(name);
        if (stage.is_wanted(options)) continue;
        throw UsageError(fmt::format("{} is left out of this run: --{} on asks for it", name,
                                     stage.switched_on_by));
    }
}

bool StageRow::is_wanted(const ReindexOptions& options) const {
    if (switched_on_by.empty()) return true;
    ReindexOptions copy = options;
    const auto rows = option_rows(copy);
    const auto row = std::ranges::find_if(
        rows, [&](const OptionRow& one) { return one.name == switched_on_by; });
    return row->get() == "on";
}

std::string StageRow::file_name(const Shard* shard) const {
    return shard ? name + "-" + shard->cut + ".h5" : name + ".h5";
}

std::vector<const FinishedWork*> StageTask::inputs_of(std::string_view stage) const {
    std::vector<const FinishedWork*> found;
    for (const FinishedWork& work : inputs) {
        if (work.receipt.stage == stage) found.push_back(&work);
    }
    return found;
}

}  // namespace kinetome
