#include "command.h"
#include "kinetome/stages/run_estimate.h"
#include "print_plan.h"

namespace kinetome::cli {
namespace {

struct PlanOptions {
    EstimateRequest request;
    std::vector<std::string> only;
    bool open = false;
    std::string format = "text";
};

void add_options(CLI::App& app, PlanOptions& options) {
    ReindexRequest& run = options.request.run;
    app.add_option("CORPUS", run.corpus, "folder of takes")->required();
    app.add_option("--store", run.store, "store to write to; it need not exist")->required();
    app.add_option("--only", options.only, "stages to bring up to date, separated by commas")
        ->delimiter(',');
    app.add_flag("--copy", run.copy, "as for reindex: room for copies is counted");
    app.add_option("--ranks", options.request.ranks,
                   "MPI processes, each with --threads (default: 1, for jobs those that help)")
        ->check(CLI::Range(1, 1'000'000));
    app.add_option("--rates", options.request.rates,
                   "file of stage_rates_bench (default: what the last generation took)");
    app.add_flag("--open", options.open,
                 "open the run that `ingest --join` and `reindex --join` take part in");
    app.add_option("--format", options.format,
                   "text, json, or shell: name=value to ask a scheduler for, with margins")
        ->check(CLI::IsMember({"text", "json", "shell"}))
        ->capture_default_str();
}

void print(const RunEstimate& estimate, const std::string& format) {
    if (format == "json") return print_plan_json(estimate);
    if (format == "shell") return print_plan_shell(estimate);
    print_plan_text(estimate);
}

}  // namespace

Command plan_command() {
    return {"plan", "tell what reindex would take: seconds, memory, disk, and how many ranks help",
            "kinetome plan takes/ --store motion.store --ranks 4", [](CLI::App& app) -> Run {
                auto options = std::make_shared<PlanOptions>();
                auto flags = std::make_shared<ReindexFlags>(app);
                add_options(app, *options);
                return [=](const Invocation& invocation) {
                    ReindexRequest& run = options->request.run;
                    run.options = flags->resolve();
                    run.resources = invocation.resources();
                    if (options->open) invocation.require_joined();
                    run.only = {options->only.begin(), options->only.end()};
                    Survey survey = options->open
                                        ? open_run(run, invocation.log, invocation.stop).survey
                                        : survey_corpus(run.corpus, run.resources.threads,
                                                        invocation.log, invocation.stop);
                    const RunEstimate estimate =
                        estimate_run(options->request, std::move(survey), invocation.log);
                    print(estimate, options->format);
                    require_room(run.store, estimate.need, estimate.free);
                    return ExitCode::success;
                };
            }};
}

}  // namespace kinetome::cli
