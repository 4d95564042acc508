// Started by a launcher of parallel jobs that does not join its processes.
#include "small_corpus.h"

namespace {

constexpr int usage = 64;

CommandResult run_as_task(std::vector<std::string> arguments) {
    Command command = program(std::move(arguments));
    command.words.insert(command.words.begin(),
                         {"env", "-u", "PMIX_RANK", "SLURM_STEP_NUM_TASKS=4"});
    return run(std::move(command));
}

}  // namespace

TEST_CASE("one of several tasks that do not know each other refuses to write", "[launcher]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const std::string takes = corpus.path().string(), store = corpus.store().string();
    const std::vector<std::vector<std::string>> writing = {
        {"reindex", takes, "--store", store},
        {"ingest", takes, "--store", store},
        {"plan", takes, "--store", store, "--open"},
        {"generate", "--frames", "100", "-o", store},
    };
    for (const auto& words : writing) {
        INFO(joined(words));
        const CommandResult refused = run_as_task(words);
        CHECK(refused.exit_code == usage);
        CHECK(contains(refused.errors, "srun started 4 processes"));
        CHECK_FALSE(fs::exists(corpus.store()));
    }
    corpus.reindex(0);
    for (const std::string command : {"publish", "gc"}) {
        INFO(command);
        CHECK(run_as_task({command, store}).exit_code == usage);
    }
}

TEST_CASE("tasks that do not know each other may read, and take a slice each", "[launcher]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const std::string takes = corpus.path().string(), store = corpus.store().string();
    for (const std::string slice : {"1/2", "2/2"}) {
        CHECK(run_as_task({"ingest", takes, "--store", store, "--slice", slice}).exit_code == 0);
    }
    corpus.reindex(0);
    CHECK(run_as_task({"info", store}).exit_code == 0);
    CHECK(run_as_task({"verify", store}).exit_code == 0);
}
