#include <fmt/format.h>

#include <algorithm>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"
#include "kinetome/stages/generation_record.h"
#include "kinetome/stages/reindex.h"
#include "run_frame.h"
#include "run_in_progress.h"

namespace kinetome {
namespace {

void set_options(const std::map<std::string, std::string>& values, ReindexOptions& options) {
    for (OptionRow& row : option_rows(options)) {
        const auto given = values.find(row.name);
        if (given != values.end()) row.set(given->second);
    }
}

/// Whether both are for the same takes and for options that differ in those of `stages` alone.
bool differ_only_in(const std::set<std::string>& stages, const RunRecord& a, const RunRecord& b) {
    ReindexOptions options_of_a = a.options, options_of_b = b.options;
    const auto rows_of_a = option_rows(options_of_a), rows_of_b = option_rows(options_of_b);
    for (size_t i = 0; i < rows_of_a.size(); ++i) {
        if (!stages.count(rows_of_a[i].stage) && rows_of_a[i].get() != rows_of_b[i].get())
            return false;
    }
    return std::ranges::equal(a.survey.takes, b.survey.takes, [](const Take& x, const Take& y) {
        return x.name == y.name && x.content == y.content;
    });
}

/// What is finished of another run would be lost.
void require_none_else(const RunInProgress& run, const RunRecord& record,
                       const RemakeRequest& request) {
    const auto opened = run.opened();
    if (!opened || differ_only_in(request.stages, *opened, record)) return;
    throw CreateError(fmt::format(
        "{}: another run is in progress: finish it with the command that began it first",
        path_for_message(request.store.string())));
}

/// Those stages and all that are made of them.
std::set<std::string> with_dependents(std::set<std::string> stages) {
    for (const StageRow& stage : stage_table()) {  // inputs come before those who need them
        if (std::ranges::any_of(stage.inputs,
                                [&](const std::string& input) { return stages.count(input) > 0; }))
            stages.insert(stage.name);
    }
    return stages;
}

void require_inputs(const RunPlan& plan, const FinishedPlan& finished, const Selection& selection,
                    const std::filesystem::path& store) {
    for (const size_t i : work_to_make(plan, finished, selection)) {
        for (const size_t input : plan.inputs_of(plan.work[i])) {
            if (finished[input] || selection.stages.count(plan.work[input].stage->name)) continue;
            throw UsageError(fmt::format(
                "{} needs {}, which the store does not have as this version makes it; `kinetome "
                "reindex {} --store {}` makes it",
                plan.work[i].stage->name, plan.work[input].file_name,
                path_for_message(plan.survey.corpus.string()), path_for_message(store.string())));
        }
    }
}

}  // namespace

RunSummary remake(const RemakeRequest& request, const Log& terminal, const StopToken& stop) {
    const Meter meter;
    const auto limit = limit_threads(request.resources);
    announce(request.resources, terminal);
    StoreDirectory store = StoreDirectory::open(request.store);
    const StoreLock lock = store.lock_writer();
    RunInProgress run(store, terminal);
    run.workspace().remove_leftovers();
    if (!run.last()) {
        throw UsageError(
            fmt::format("{0} has no generation yet to go on from; `kinetome reindex CORPUS --store "
                        "{0}` makes one",
                        path_for_message(request.store.string())));
    }
    RunRecord record = record_of(*run.last());
    set_options(request.options, record.options);
    check_options(record.options);
    require_none_else(run, record, request);
    const RunPlan plan(record.survey, record.options);
    const Selection selection{
        .stages = with_dependents(request.stages), .slice = {}, .copies = request.copy};
    const FinishedPlan before = find_finished(plan, run.workspace());
    require_inputs(plan, before, selection, request.store);
    require_room(plan, before, selection, run.workspace());
    run.enter(record, "");
    SerialCommunicator alone;
    const FinishedPlan after = carry_out(
        plan, before, selection, {run.workspace(), request.resources, run.log(), stop, alone});
    return sum_up(publish_and_forget(run, plan, after, request.copy), plan, before, after, meter);
}

}  // namespace kinetome
