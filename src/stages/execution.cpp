#include "kinetome/stages/execution.h"

#include <fmt/format.h>

#include <algorithm>

#include "kinetome/base/error.h"
#include "kinetome/run/meter.h"
#include "kinetome/stages/disk_need.h"

namespace kinetome {
namespace {

bool is_selected(const RunPlan& plan, const PlannedWork& work, const Selection& selection) {
    if (!selection.stages.empty() && !selection.stages.count(work.stage->name)) return false;
    if (!selection.slice) return true;
    if (!work.shard) return false;
    const auto position = static_cast<size_t>(work.shard - plan.shards.data());
    const auto mine = shards_of_slice(plan.shards, *selection.slice);
    return std::find(mine.begin(), mine.end(), position) != mine.end();
}

StageTask task_of(const RunPlan& plan, const PlannedWork& work, const FinishedPlan& finished,
                  const Workspace& workspace) {
    StageTask task;
    task.output = workspace.folder() / work.file_name;
    task.header = {.stage = work.stage->name, .key = work.key.digest()};
    task.shard = work.shard;
    for (const size_t input : plan.inputs_of(work)) {
        if (!finished[input]) {
            throw UsageError(fmt::format("{} needs {}, which is not up to date: add '{}' to --only",
                                         work.stage->name, plan.work[input].file_name,
                                         plan.work[input].stage->name));
        }
        task.inputs.push_back(*finished[input]);
    }
    return task;
}

FinishedWork make(const RunPlan& plan, const PlannedWork& work, const StageTask& task,
                  const Workspace& workspace, const Resources& resources, const Log& log,
                  const StopToken& stop) {
    log.info("{}: to be made: {}", work.file_name, workspace.why_missing(work.file_name, work.key));
    const Meter meter;
    StageResult result = work.stage->make(
        {plan.survey, plan.shards, plan.options, resources, workspace, log, stop}, task);
    Receipt receipt;
    receipt.stage = work.stage->name;
    receipt.shard = work.shard ? work.shard->cut : "";
    receipt.key = work.key;
    receipt.file = std::move(result.file);
    receipt.clips = std::move(result.clips);
    receipt.cost = meter.cost();
    log.info("{}: made in {:.2f} s, {}", work.file_name, receipt.cost.seconds,
             describe_bytes(receipt.file.bytes));
    return workspace.commit(std::move(receipt));
}

}  // namespace

std::vector<size_t> work_to_make(const RunPlan& plan, const FinishedPlan& finished,
                                 const Selection& selection) {
    std::vector<size_t> positions;
    for (size_t i = 0; i < plan.work.size(); ++i) {
        if (!finished[i] && is_selected(plan, plan.work[i], selection)) positions.push_back(i);
    }
    return positions;
}

void require_room(const RunPlan& plan, const FinishedPlan& finished, const Selection& selection,
                  const Workspace& workspace) {
    const CorpusShape corpus = corpus_shape(plan.survey, plan.shards, plan.options);
    require_room(workspace.store().path(),
                 disk_need(plan, corpus, planned_bytes(plan, corpus, workspace.last()),
                           work_to_make(plan, finished, selection), selection.copies),
                 free_space(workspace.folder()));
}

FinishedPlan find_finished(const RunPlan& plan, const Workspace& workspace,
                           const Selection& selection) {
    FinishedPlan finished;
    for (const PlannedWork& work : plan.work) {
        finished.push_back(is_selected(plan, work, selection)
                               ? workspace.find(work.file_name, work.key)
                               : std::nullopt);
    }
    return finished;
}

FinishedPlan carry_out(const RunPlan& plan, FinishedPlan finished, const Selection& selection,
                       const Workspace& workspace, const Resources& resources, const Log& log,
                       const StopToken& stop) {
    require_room(plan, finished, selection, workspace);
    for (size_t i = 0; i < plan.work.size(); ++i) {
        const PlannedWork& work = plan.work[i];
        if (!is_selected(plan, work, selection)) continue;
        if (finished[i]) {
            log.info("{}: reused from {}: its key is complete", work.file_name,
                     finished[i]->from_generation ? "generation " + workspace.last()->id()
                                                  : "the run in progress");
            continue;
        }
        stop.check();
        finished[i] = make(plan, work, task_of(plan, work, finished, workspace), workspace,
                           resources, log, stop);
    }
    return finished;
}

}  // namespace kinetome
