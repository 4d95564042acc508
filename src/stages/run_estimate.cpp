#include "kinetome/stages/run_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "kinetome/base/error.h"
#include "kinetome/run/communicator.h"
#include "kinetome/stages/peak_memory.h"
#include "kinetome/stages/stage_loads.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

/// What is there already, looked at without leaving a trace.
struct ExistingStore {
    ExistingStore(const fs::path& path, const Log& log) : store(StoreDirectory::find(path)) {
        if (!store) return;
        try {
            if (const auto id = store->current()) last.emplace(*store, *id, verified);
        } catch (const DamagedError& error) {
            log.warning("the current generation cannot be built on: {}", error.what());
        }
        workspace.emplace(*store, generation(), verified, Workspace::Purpose::look);
    }
    const Generation* generation() const { return last ? &*last : nullptr; }

    std::optional<StoreDirectory> store;
    VerifiedFiles verified;
    std::optional<Generation> last;
    std::optional<Workspace> workspace;
};

/// Rates, and by how much the work that they are corrected by differed from them.
struct Pace {
    Rates rates;
    std::map<std::string, double> corrections;
    std::string source;
};

Pace pace_of(const EstimateRequest& request, const Generation* last) {
    if (!request.rates.empty()) {
        return {read_rates(request.rates), {}, request.rates.string()};
    }
    Pace pace{shipped_rates(), {}, ""};
    if (last) pace.corrections = second_corrections(*last, pace.rates);
    pace.source = pace.corrections.empty()
                      ? "shipped with the program: " + pace.rates.machine
                      : fmt::format("generation {}, which took so long", last->id());
    return pace;
}

/// Makes one estimate.
class Estimator {
  public:
    Estimator(const EstimateRequest& request, const RunPlan& plan, const ExistingStore& existing)
        : request_(request),
          plan_(plan),
          corpus_(corpus_shape(plan.survey, plan.shards, plan.options)),
          pace_(pace_of(request, existing.generation())),
          finished_(existing.workspace ? find_finished(plan, *existing.workspace)
                                       : FinishedPlan(plan.work.size())),
          to_make_(work_to_make(plan, finished_, selection())),
          bytes_(planned_bytes(plan, corpus_, existing.generation())) {
        for (const StageRow& stage : stage_table()) loads_[stage.name] = load_of(stage);
    }

    RunEstimate run() const {
        RunEstimate estimate;
        describe_corpus(estimate);
        estimate.ranks = request_.ranks.value_or(1);
        estimate.threads = threads();
        estimate.rates_source = pace_.source;
        for (const StageRow& stage : stage_table()) {
            if (!stage.is_wanted(plan_.options)) continue;
            StageEstimate one = stage_estimate(stage, estimate.ranks);
            estimate.seconds += one.seconds;
            estimate.peak_bytes = std::max(estimate.peak_bytes, one.peak_bytes);
            estimate.stages.push_back(std::move(one));
        }
        estimate.by_ranks = tabulate_ranks([&](int ranks) { return seconds({}, ranks); });
        estimate.helpful_ranks = ranks_that_help(estimate.by_ranks);
        estimate.need = disk_need(plan_, corpus_, bytes_, to_make_, request_.run.copy);
        estimate.free = free_space(request_.run.store);
        estimate.job = job();
        return estimate;
    }

  private:
    Selection selection() const {
        return {.stages = request_.run.only, .slice = {}, .copies = request_.run.copy};
    }
    int threads() const { return request_.run.resources.threads; }

    /// Positions in the plan of what a stage has to make.
    std::vector<size_t> to_make(const StageRow& stage) const {
        std::vector<size_t> positions;
        for (const size_t i : to_make_) {
            if (plan_.work[i].stage == &stage) positions.push_back(i);
        }
        return positions;
    }

    StageLoad load_of(const StageRow& stage) const {
        StageLoad load = stage_load(stage.name, corpus_, plan_.options, pace_.rates);
        const std::vector<size_t> positions = to_make(stage);
        if (stage.sharded || positions.empty()) load.items.clear();
        if (stage.sharded) {
            for (const size_t i : positions) {
                load.items.push_back(shard_item(stage.name, plan_.work[i].shard->cut, corpus_,
                                                plan_.options, pace_.rates));
            }
        }
        const auto correction = pace_.corrections.find(stage.name);
        if (correction != pace_.corrections.end()) {
            for (LoadItem& item : load.items) {
                item.seconds *= correction->second;
                item.fixed_seconds *= correction->second;
            }
        }
        return load;
    }

    /// Of all stages but those left out.
    double seconds(const std::string& left_out, int ranks) const {
        double total = 0;
        for (const StageRow& stage : stage_table()) {
            if (stage.name != left_out)
                total += load_seconds(loads_.at(stage.name), threads(), ranks);
        }
        return total;
    }

    uint64_t peak(const std::string& stage, int ranks) const {
        return peak_memory(stage, corpus_, plan_.options, request_.run.resources, ranks);
    }

    StageEstimate stage_estimate(const StageRow& stage, int ranks) const {
        StageEstimate one;
        one.name = stage.name;
        const StageLoad& load = loads_.at(stage.name);
        const std::vector<size_t> positions = to_make(stage);
        one.to_make = static_cast<int64_t>(positions.size());
        for (size_t i = 0; i < plan_.work.size(); ++i) {
            one.reused += plan_.work[i].stage == &stage && finished_[i].has_value();
        }
        for (const size_t i : positions) one.bytes += bytes_[i];
        for (const LoadItem& item : load.items) one.frames += item.amount;
        one.seconds = load_seconds(load, threads(), ranks);
        if (one.to_make > 0) one.peak_bytes = peak(stage.name, ranks);
        return one;
    }

    void describe_corpus(RunEstimate& estimate) const {
        estimate.takes = static_cast<int64_t>(corpus_.clips.size());
        estimate.left_out = static_cast<int64_t>(plan_.survey.takes.size()) - estimate.takes;
        estimate.frames = corpus_.frames();
        for (const ClassShape& shape : corpus_.classes) {
            estimate.classes.push_back({shape.name, 0, 0});
        }
        for (const ClipShape& clip : corpus_.clips) {
            ClassEstimate& its_class = estimate.classes[clip.clip_class];
            ++its_class.takes;
            its_class.frames += clip.frames;
        }
        for (const PartitionShape& partition : partition_shapes(corpus_, plan_.options)) {
            ++estimate.partitions;
            estimate.largest_partition = std::max(estimate.largest_partition, partition.rows);
            estimate.most_clusters = std::max(estimate.most_clusters, partition.most_clusters());
        }
    }

    /// Of the longest of so many slices.
    double slice_seconds(int slices) const {
        const StageLoad& frames = loads_.at("frames");
        const auto positions = to_make(stage_table().front());
        std::map<const Shard*, const LoadItem*> to_ingest;
        for (size_t i = 0; i < positions.size(); ++i) {
            to_ingest[plan_.work[positions[i]].shard] = &frames.items[i];
        }
        double longest = 0;
        for (int index = 1; index <= slices; ++index) {
            StageLoad mine;
            mine.serial_share = frames.serial_share;
            for (const size_t shard : shards_of_slice(plan_.shards, {index, slices})) {
                const auto found = to_ingest.find(&plan_.shards[shard]);
                if (found != to_ingest.end()) mine.items.push_back(*found->second);
            }
            longest = std::max(longest, load_seconds(mine, threads(), 1));
        }
        return longest;
    }

    int ranks_for_a_job() const {
        if (!can_join_ranks()) return 1;
        return ranks_that_help(tabulate_ranks([&](int ranks) { return seconds("frames", ranks); }));
    }

    JobEstimate job() const {
        JobEstimate job;
        const auto shards = static_cast<int>(loads_.at("frames").items.size());
        const int most_tasks = std::max(1, std::min(shards, request_.ranks.value_or(shards)));
        job.ingest_tasks = ranks_that_help(
            tabulate_ranks([&](int tasks) { return slice_seconds(tasks); }, most_tasks));
        job.ingest_seconds = slice_seconds(job.ingest_tasks);
        job.ingest_bytes = peak("frames", 1);
        job.ranks = request_.ranks.value_or(ranks_for_a_job());
        job.seconds = seconds("frames", job.ranks);
        for (const StageRow& stage : stage_table()) {
            if (stage.name != "frames")
                job.bytes = std::max(job.bytes, peak(stage.name, job.ranks));
        }
        return job;
    }

    const EstimateRequest& request_;
    const RunPlan& plan_;
    const CorpusShape corpus_;
    const Pace pace_;
    const FinishedPlan finished_;
    const std::vector<size_t> to_make_;
    const std::vector<uint64_t> bytes_;
    std::map<std::string, StageLoad> loads_;
};

}  // namespace

RunEstimate estimate_run(const EstimateRequest& request, Survey survey, const Log& log) {
    require_wanted(request.run.only, request.run.options);
    const ExistingStore existing(request.run.store, log);
    const RunPlan plan(std::move(survey), request.run.options);
    return Estimator(request, plan, existing).run();
}

}  // namespace kinetome
