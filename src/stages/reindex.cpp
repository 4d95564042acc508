#include "kinetome/stages/reindex.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <map>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/base/quote.h"
#include "kinetome/run/meter.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

/// A store with its last generation and the work in progress. `log` also writes to the run's file.
struct OpenRun {
    OpenRun(const StoreDirectory& directory, const Log& terminal)
        : store(directory), log(terminal) {
        if (const auto id = store.current()) open_last(*id);
        workspace.emplace(store, last ? &*last : nullptr, verified);
        log.add_file(log_file());
    }
    fs::path log_file() const { return workspace->folder() / "log.txt"; }
    fs::path record() const { return workspace->folder() / "run.json"; }

    /// A damaged generation stays current until the run has made a whole one.
    void open_last(const std::string& id) {
        try {
            last.emplace(store, id, verified);
        } catch (const DamagedError& error) {
            log.warning("generation {} cannot be built on: {}; everything is made again", id,
                        error.what());
        }
    }

    StoreDirectory store;
    VerifiedFiles verified;
    std::optional<Generation> last;
    std::optional<Workspace> workspace;
    Log log;
};

/// oneTBB's share of the one thread count; OpenMP regions are given theirs explicitly.
tbb::global_control limit_threads(const Resources& resources) {
    return tbb::global_control(tbb::global_control::max_allowed_parallelism,
                               static_cast<size_t>(resources.threads));
}

void announce(const Resources& resources, const Log& log) {
    log.info("threads: {} ({}); memory: {} ({})", resources.threads, resources.threads_source,
             describe_bytes(resources.memory_bytes), resources.memory_source);
}

/// Before anything is made on disk for it.
void require_folder(const fs::path& corpus) {
    std::error_code error;
    if (fs::is_directory(corpus, error)) return;
    throw Error(ExitCode::nothing_usable, fmt::format("{}: {}", path_for_message(corpus.string()),
                                                      error ? error.message() : "no such folder"));
}

/// Tells the plan, and leaves the record that `publish` starts from.
void enter(const RunPlan& plan, const OpenRun& run) {
    run.log.info("{}: {} takes claim {} frames; {} shards of about {} frames",
                 plan.survey.corpus.string(), plan.survey.takes.size(),
                 plan.survey.claimed_frames(), plan.shards.size(),
                 plan.options.frames.shard_frames);
    write_file_atomically(run.record(), write_run_record(plan.survey, plan.options));
}

std::vector<StageSummary> summarise(const RunPlan& plan, const FinishedPlan& before,
                                    const FinishedPlan& after) {
    std::vector<StageSummary> summaries;
    for (const StageRow& stage : stage_table()) {
        StageSummary summary;
        summary.name = stage.name;
        for (size_t i = 0; i < plan.work.size(); ++i) {
            if (plan.work[i].stage != &stage || !after[i]) continue;
            const Receipt& receipt = after[i]->receipt;
            summary.bytes += receipt.file.bytes;
            if (before[i]) {
                ++summary.reused;
                continue;
            }
            ++summary.made;
            summary.cost.seconds += receipt.cost.seconds;
            summary.cost.cpu_seconds += receipt.cost.cpu_seconds;
            summary.cost.peak_bytes = std::max(summary.cost.peak_bytes, receipt.cost.peak_bytes);
        }
        summaries.push_back(summary);
    }
    return summaries;
}

/// Publishes, then forgets the run in progress, unless it holds work of stages that were left out.
RunSummary finish(OpenRun& run, const RunPlan& plan, const FinishedPlan& before,
                  const FinishedPlan& after, bool copy, const Meter& meter) {
    RunSummary summary;
    summary.publication = publish_plan(plan, after, *run.workspace, copy, run.log_file(), run.log);
    summary.stages = summarise(plan, before, after);
    summary.cost = meter.cost();
    for (const StageSummary& stage : summary.stages) {
        summary.cost.peak_bytes = std::max(summary.cost.peak_bytes, stage.cost.peak_bytes);
    }
    const bool all_published =
        std::all_of(after.begin(), after.end(), [](const auto& work) { return work.has_value(); });
    if (all_published) run.workspace->remove();
    return summary;
}

}  // namespace

RunSummary reindex(const ReindexRequest& request, const Log& terminal, const StopToken& stop) {
    const Meter meter;
    const auto limit = limit_threads(request.resources);
    announce(request.resources, terminal);
    for (const std::string& stage : request.only) stage_named(stage);
    require_folder(request.corpus);

    StoreDirectory store = StoreDirectory::open_or_create(request.store);
    const StoreLock lock = store.lock_writer();
    OpenRun run(store, terminal);
    run.workspace->remove_leftovers();

    const RunPlan plan(survey_corpus(request.corpus, request.resources.threads, run.log, stop),
                       request.options);
    enter(plan, run);
    const uint64_t survey_peak = meter.cost().peak_bytes;  // stages reset the kernel's counter
    const FinishedPlan before = find_finished(plan, *run.workspace);
    const FinishedPlan after = carry_out(plan, before, {.stages = request.only, .slice = {}},
                                         *run.workspace, request.resources, run.log, stop);
    RunSummary summary = finish(run, plan, before, after, request.copy, meter);
    summary.cost.peak_bytes = std::max(summary.cost.peak_bytes, survey_peak);
    return summary;
}

IngestSummary ingest(const ReindexRequest& request, const std::optional<Slice>& slice,
                     const Log& terminal, const StopToken& stop) {
    const auto limit = limit_threads(request.resources);
    announce(request.resources, terminal);
    require_folder(request.corpus);
    StoreDirectory store = StoreDirectory::open_or_create(request.store);
    const StoreLock lock =
        slice ? store.lock_slice(fmt::format("slice-{}-of-{}", slice->index, slice->count))
              : store.lock_writer();
    OpenRun run(store, terminal);

    const RunPlan plan(survey_corpus(request.corpus, request.resources.threads, run.log, stop),
                       request.options);
    enter(plan, run);
    const FinishedPlan finished =
        carry_out(plan, find_finished(plan, *run.workspace), {.stages = {"frames"}, .slice = slice},
                  *run.workspace, request.resources, run.log, stop);

    const Catalog catalog = make_catalog(plan, finished, nullptr);
    std::set<std::string> mine;
    for (size_t i = 0; i < plan.shards.size(); ++i) {
        if (!slice) mine.insert(plan.shards[i].cut);
    }
    if (slice) {
        for (const size_t i : shards_of_slice(plan.shards, *slice)) mine.insert(plan.shards[i].cut);
    }
    IngestSummary summary;
    for (const CatalogClip& clip : catalog.clips) {
        if (!mine.count(clip.shard)) continue;
        summary.frames += clip.frames;
        ++(clip.indexed() ? summary.indexed : summary.quarantined);
        if (!clip.indexed()) summary.reasons.push_back(clip.quarantined);
    }
    return summary;
}

RunSummary publish(const fs::path& path, const Resources& resources, bool copy,
                   const Log& terminal) {
    const Meter meter;
    const auto limit = limit_threads(resources);
    StoreDirectory store = StoreDirectory::open(path);
    const StoreLock lock = store.lock_writer();
    OpenRun run(store, terminal);
    if (!fs::exists(run.record())) {
        run.workspace->remove();
        throw Error(ExitCode::nothing_usable,
                    path.string() + ": no run in progress: `kinetome ingest` opens one");
    }
    RunRecord record = parse_run_record(read_file(run.record()), run.record());
    const RunPlan plan(std::move(record.survey), record.options);
    const FinishedPlan finished = find_finished(plan, *run.workspace);
    return finish(run, plan, finished, finished, copy, meter);
}

}  // namespace kinetome
