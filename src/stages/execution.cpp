#include "kinetome/stages/execution.h"

#include <fmt/format.h>

#include <algorithm>

#include "kinetome/base/error.h"
#include "kinetome/base/packing.h"
#include "kinetome/run/meter.h"
#include "kinetome/stages/disk_need.h"
#include "kinetome/stages/work_share.h"

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

/// What a piece of work cost all who made it: the first one's seconds, everybody's processor time,
/// the largest peak.
Cost cost_of_all(Cost mine, Communicator& ranks) {
    Packer out;
    out.put(mine.cpu_seconds).put(mine.peak_bytes);
    mine.cpu_seconds = 0;
    for (std::string& part : ranks.gather(out.take())) {
        Unpacker in(std::move(part));
        mine.cpu_seconds += in.get<double>();
        mine.peak_bytes = std::max(mine.peak_bytes, in.get<uint64_t>());
    }
    return mine;
}

/// Makes an artifact, alone or together with the other ranks; rank 0 of those who make it has the
/// result.
std::optional<FinishedWork> make(const RunPlan& plan, const PlannedWork& work,
                                 const StageTask& task, const Execution& execution,
                                 Communicator* ranks) {
    const Workspace& workspace = execution.workspace;
    const Log& log = execution.log;
    const StageContext context{plan.survey, plan.shards, plan.options,   execution.resources,
                               workspace,   log,         execution.stop, ranks};
    const Meter meter;
    StageResult result = work.stage->make(context, task);
    const Cost cost = ranks ? cost_of_all(meter.cost(), *ranks) : meter.cost();
    if (!context.is_root()) return std::nullopt;
    Receipt receipt;
    receipt.stage = work.stage->name;
    receipt.shard = work.shard ? work.shard->cut : "";
    receipt.key = work.key;
    receipt.file = std::move(result.file);
    receipt.clips = std::move(result.clips);
    receipt.cost = cost;
    log.info("{}: made in {:.2f} s, {}", work.file_name, receipt.cost.seconds,
             describe_bytes(receipt.file.bytes));
    return workspace.commit(std::move(receipt));
}

void pack(Packer& out, const FinishedWork& work) {
    out.put(std::string_view(write_receipt(work.receipt)))
        .put(std::string_view(work.path.native()));
    out.put<uint8_t>(work.from_generation);
}

FinishedWork unpack_work(Unpacker& in) {
    const std::string receipt = in.get_text();
    const std::filesystem::path path = in.get_text();
    return {parse_receipt(receipt, path), path, in.get<uint8_t>() != 0};
}

/// The work of a stage that is selected and not finished: positions in the plan.
std::vector<size_t> work_to_do(const RunPlan& plan, const StageRow& stage,
                               const Selection& selection, const FinishedPlan& finished,
                               const Execution& execution) {
    std::vector<size_t> to_do;
    for (size_t i = 0; i < plan.work.size(); ++i) {
        const PlannedWork& work = plan.work[i];
        if (work.stage != &stage || !is_selected(plan, work, selection)) continue;
        if (!finished[i]) to_do.push_back(i);
        if (!execution.ranks.is_root()) continue;
        if (!finished[i]) {
            execution.log.info("{}: to be made: {}", work.file_name,
                               execution.workspace.why_missing(work.file_name, work.key));
        } else {
            execution.log.info("{}: reused from {}: its key is complete", work.file_name,
                               finished[i]->from_generation
                                   ? "generation " + execution.workspace.last()->id()
                                   : "the run in progress");
        }
    }
    return to_do;
}

/// Each shard by one rank; then all know of all.
void make_shards(const RunPlan& plan, const std::vector<size_t>& to_do, FinishedPlan& finished,
                 const Execution& execution) {
    std::vector<int64_t> frames;
    for (const size_t i : to_do) frames.push_back(plan.work[i].shard->claimed_frames);
    const std::vector<int> owners = share_out(frames, execution.ranks.size(), false);
    Packer made;
    for (size_t i = 0; i < to_do.size(); ++i) {
        if (owners[i] != execution.ranks.rank()) continue;
        execution.stop.check();
        execution.ranks.check();
        const PlannedWork& work = plan.work[to_do[i]];
        const StageTask task = task_of(plan, work, finished, execution.workspace);
        finished[to_do[i]] = make(plan, work, task, execution, nullptr);
        pack(made, *finished[to_do[i]]);
    }
    const auto brought = execution.ranks.gather_to_all(made.take());
    for (int rank = 0; rank < execution.ranks.size(); ++rank) {
        if (rank == execution.ranks.rank()) continue;
        Unpacker in(brought[static_cast<size_t>(rank)]);
        for (size_t i = 0; i < to_do.size(); ++i) {
            if (owners[i] != rank) continue;
            const FinishedWork& work = finished[to_do[i]].emplace(unpack_work(in));
            if (!execution.ranks.is_root()) continue;
            execution.log.info("{}: made by rank {} in {:.2f} s, {}", work.receipt.file.file_name,
                               rank, work.receipt.cost.seconds,
                               describe_bytes(work.receipt.file.bytes));
        }
    }
}

void make_together(const RunPlan& plan, size_t position, FinishedPlan& finished,
                   const Execution& execution) {
    execution.stop.check();
    const PlannedWork& work = plan.work[position];
    const StageTask task = task_of(plan, work, finished, execution.workspace);
    Communicator* ranks = execution.ranks.size() > 1 ? &execution.ranks : nullptr;
    finished[position] = make(plan, work, task, execution, ranks);
    Packer made;
    if (finished[position]) pack(made, *finished[position]);
    Unpacker in(execution.ranks.broadcast(made.take()));
    if (!finished[position]) finished[position] = unpack_work(in);
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
                       const Execution& execution) {
    for (const StageRow& stage : stage_table()) {
        const auto to_do = work_to_do(plan, stage, selection, finished, execution);
        if (to_do.empty()) continue;
        if (stage.sharded) {
            make_shards(plan, to_do, finished, execution);
        } else {
            make_together(plan, to_do.front(), finished, execution);
        }
    }
    execution.ranks.wait_for_all();  // a rank with nothing to do would publish under the others
    return finished;
}

std::string pack_finished(const FinishedPlan& finished) {
    Packer out;
    for (const auto& work : finished) {
        out.put<uint8_t>(work.has_value());
        if (work) pack(out, *work);
    }
    return out.take();
}

FinishedPlan unpack_finished(std::string bytes) {
    FinishedPlan finished;
    for (Unpacker in(std::move(bytes)); in.left() > 0;) {
        const bool is_finished = in.get<uint8_t>() != 0;
        finished.push_back(is_finished ? std::optional(unpack_work(in)) : std::nullopt);
    }
    return finished;
}

}  // namespace kinetome
