#include "run_frame.h"

#include <algorithm>
#include <utility>

namespace kinetome {
namespace {

std::vector<StageSummary> summarise(const RunPlan& plan, const FinishedPlan& before,
                                    const FinishedPlan& after) {
    std::vector<StageSummary> summaries;
    for (const StageRow& stage : stage_table()) {
        if (!stage.is_wanted(plan.options)) continue;
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

}  // namespace

tbb::global_control limit_threads(const Resources& resources) {
    return tbb::global_control(tbb::global_control::max_allowed_parallelism,
                               static_cast<size_t>(resources.threads));
}

void announce(const Resources& resources, const Log& log) {
    log.info("threads: {} ({}); memory: {} ({})", resources.threads, resources.threads_source,
             describe_bytes(resources.memory_bytes), resources.memory_source);
}

Publication publish_and_forget(RunInProgress& run, const RunPlan& plan,
                               const FinishedPlan& finished, bool copy) {
    Publication publication = publish_plan(plan, finished, run.workspace(), copy, run.log());
    const bool all_published = std::all_of(finished.begin(), finished.end(),
                                           [](const auto& work) { return work.has_value(); });
    if (all_published) run.workspace().remove();
    return publication;
}

RunSummary sum_up(Publication publication, const RunPlan& plan, const FinishedPlan& before,
                  const FinishedPlan& after, const Meter& meter) {
    RunSummary summary;
    summary.publication = std::move(publication);
    summary.stages = summarise(plan, before, after);
    summary.cost = meter.cost();
    for (const StageSummary& stage : summary.stages) {
        summary.cost.peak_bytes = std::max(summary.cost.peak_bytes, stage.cost.peak_bytes);
    }
    return summary;
}

}  // namespace kinetome
