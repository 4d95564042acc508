#include "kinetome/stages/reindex.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"
#include "kinetome/run/meter.h"
#include "rank_orders.h"
#include "run_frame.h"
#include "run_in_progress.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

/// Before anything is made on disk for it.
void require_folder(const fs::path& corpus) {
    std::error_code error;
    if (fs::is_directory(corpus, error)) return;
    throw Error(ExitCode::nothing_usable, fmt::format("{}: {}", path_for_message(corpus.string()),
                                                      error ? error.message() : "no such folder"));
}

Selection selection_of(const ReindexRequest& request) {
    return {.stages = request.only, .slice = {}, .copies = request.copy};
}

/// A joined run has its store already, and a mistyped name shall not make one.
StoreDirectory open_store(const ReindexRequest& request) {
    return request.join ? StoreDirectory::open(request.store)
                        : StoreDirectory::open_or_create(request.store);
}

/// What the run is for, nothing when that is still to be surveyed.
std::optional<RunRecord> find_opened(const ReindexRequest& request, const StoreDirectory& store) {
    return request.join ? std::optional(joined_record(request, store)) : std::nullopt;
}

/// `slice` as RunInProgress::enter has it.
RunRecord survey_and_enter(const ReindexRequest& request, RunInProgress& run,
                           const std::string& slice, const StopToken& stop) {
    const Workers workers(request.resources.threads, request.ranks);
    RunRecord record{survey_corpus(request.corpus, workers, run.log(), stop), request.options};
    run.enter(record, slice);
    return record;
}

void tell(const RunPlan& plan, const Log& log) {
    log.info("{}: {} takes claim {} frames; {} shards of about {} frames",
             plan.survey.corpus.string(), plan.survey.takes.size(), plan.survey.claimed_frames(),
             plan.shards.size(), plan.options.frames.shard_frames);
}

/// What a slice, or a run without slices, read.
IngestSummary sum_up_takes(const RunPlan& plan, const FinishedPlan& finished,
                           const std::optional<Slice>& slice) {
    std::set<std::string> mine;
    for (const size_t i : shards_of_slice(plan.shards, slice.value_or(Slice{}))) {
        mine.insert(plan.shards[i].cut);
    }
    IngestSummary summary;
    for (const CatalogClip& clip : make_catalog(plan, finished, nullptr).clips) {
        if (!mine.count(clip.shard)) continue;
        summary.frames += clip.frames;
        ++(clip.indexed() ? summary.indexed : summary.quarantined);
        if (!clip.indexed()) summary.reasons.push_back(clip.quarantined);
    }
    return summary;
}

}  // namespace

RunRecord open_run(const ReindexRequest& request, const Log& terminal, const StopToken& stop) {
    const auto limit = limit_threads(request.resources);
    announce(request.resources, terminal);
    require_folder(request.corpus);
    StoreDirectory store = StoreDirectory::open_or_create(request.store);
    const StoreLock lock = store.lock_writer();
    RunInProgress run(store, terminal);
    run.workspace().remove_leftovers();

    // Its parts may be started in other folders.
    const fs::path corpus = fs::absolute(request.corpus);
    RunRecord record{survey_corpus(corpus, request.resources.threads, run.log(), stop),
                     request.options};
    const RunPlan plan(record.survey, record.options);
    tell(plan, run.log());
    require_room(plan, find_finished(plan, run.workspace()), selection_of(request),
                 run.workspace());
    run.enter(record, "");
    return record;
}

namespace {

/// What rank 0 does beyond what all ranks do. The store is its own.
RunSummary lead(const ReindexRequest& request, StoreDirectory& store, Communicator& ranks,
                const Log& terminal, const StopToken& stop, const Meter& meter) {
    const auto opened = find_opened(request, store);
    RunInProgress run(store, terminal);
    run.workspace().remove_leftovers();

    order_survey(!opened, ranks);
    const RunRecord record = opened ? *opened : survey_and_enter(request, run, "", stop);
    require_wanted(request.only, record.options);
    const RunPlan plan(record.survey, record.options);
    tell(plan, run.log());
    const uint64_t survey_peak = meter.cost().peak_bytes;  // stages reset the kernel's counter
    const FinishedPlan before = find_finished(plan, run.workspace());
    require_room(plan, before, selection_of(request), run.workspace());
    order_work(plan, before, ranks);
    const FinishedPlan after =
        carry_out(plan, before, selection_of(request),
                  {run.workspace(), request.resources, run.log(), stop, ranks});
    Publication publication = request.publish
                                  ? publish_and_forget(run, plan, after, request.copy)
                                  : prepare_publication(plan, after, run.last(), run.log());
    RunSummary summary = sum_up(std::move(publication), plan, before, after, meter);
    summary.cost.peak_bytes = std::max(summary.cost.peak_bytes, survey_peak);
    return summary;
}

}  // namespace

RunSummary reindex(const ReindexRequest& request, const Log& terminal, const StopToken& stop) {
    const Meter meter;
    const auto limit = limit_threads(request.resources);
    announce(request.resources, terminal);
    for (const std::string& stage : request.only) stage_named(stage);
    require_folder(request.corpus);
    SerialCommunicator alone;
    Communicator& ranks = request.ranks ? *request.ranks : alone;
    if (!ranks.is_root()) {
        assist(request, selection_of(request), ranks, terminal, stop);
        return {};
    }
    StoreDirectory store = open_store(request);
    const StoreLock lock = store.lock_writer();
    try {
        return lead(request, store, ranks, terminal, stop, meter);
    } catch (const Error& error) {
        ranks.fail(error.exit_code(),
                   error.what());  // before the lock goes: the others still write
        throw;
    } catch (const std::exception& error) {
        ranks.fail(ExitCode::internal, error.what());
        throw;
    }
}

IngestSummary ingest(const ReindexRequest& request, const std::optional<Slice>& slice,
                     const Log& terminal, const StopToken& stop) {
    const auto limit = limit_threads(request.resources);
    announce(request.resources, terminal);
    require_folder(request.corpus);
    StoreDirectory store = open_store(request);
    const std::string name = slice ? fmt::format("slice-{}-of-{}", slice->index, slice->count) : "";
    const StoreLock lock = slice ? store.lock_slice(name) : store.lock_writer();
    const auto opened = find_opened(request, store);
    RunInProgress run(store, terminal, name);

    const RunRecord record = opened ? *opened : survey_and_enter(request, run, name, stop);
    const RunPlan plan(record.survey, record.options);
    tell(plan, run.log());
    const Selection mine{.stages = {"frames"}, .slice = slice};
    const FinishedPlan before = find_finished(plan, run.workspace(), mine);
    require_room(plan, before, mine, run.workspace());
    SerialCommunicator alone;
    const FinishedPlan finished =
        carry_out(plan, before, mine, {run.workspace(), request.resources, run.log(), stop, alone});
    return sum_up_takes(plan, finished, slice);
}

RunSummary publish(const fs::path& path, const Resources& resources, bool copy,
                   const Log& terminal) {
    const Meter meter;
    const auto limit = limit_threads(resources);
    StoreDirectory store = StoreDirectory::open(path);
    const StoreLock lock = store.lock_writer();
    RunInProgress run(store, terminal);
    if (!fs::exists(run.record_file())) {
        run.workspace().remove();
        throw Error(ExitCode::nothing_usable,
                    path.string() + ": no run in progress: `kinetome ingest` opens one");
    }
    RunRecord record = parse_run_record(read_file(run.record_file()), run.record_file());
    const RunPlan plan(std::move(record.survey), record.options);
    const FinishedPlan finished = find_finished(plan, run.workspace());
    return sum_up(publish_and_forget(run, plan, finished, copy), plan, finished, finished, meter);
}

}  // namespace kinetome
