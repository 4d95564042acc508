// A corpus indexed by jobs on a real, if small, Slurm cluster: when all goes well, and when tasks,
// nodes and time limits do not let it (jobs/README.md).
#include "end_to_end/small_corpus.h"
#include "held_processes.h"
#include "job_chain.h"

namespace {

constexpr int some_quarantined = 3, interrupted = 75, killed = 128 + SIGKILL;

const std::vector<std::string> few_clusters = {"--", "--clusters", "60", "--shard-frames", "8192"};

/// EM takes its time, so that it can be found at work.
std::vector<std::string> slow_clustering(std::vector<std::string> submit_options = {}) {
    const std::vector<std::string> reindex_options = {
        "--", "--clusters",       "1000", "--shard-frames", "8192", "--min-gain",
        "0",  "--max-iterations", "150"};
    submit_options.insert(submit_options.end(), reindex_options.begin(), reindex_options.end());
    return submit_options;
}

/// Digests of what one process without Slurm makes of the corpus.
std::string serial_digests(const fs::path& corpus, const std::vector<std::string>& submit_options) {
    const TemporaryFolder folder;
    const StoreOnDisk store(folder / "store");
    const auto options = std::find(submit_options.begin(), submit_options.end(), "--");
    std::vector<std::string> words = {"reindex", corpus.string(), "--store", store.name()};
    words.insert(words.end(), options + 1, submit_options.end());
    require_program(words);
    return store.digests();
}

/// A corpus whose clustering can be found at work, and the store that jobs make of it.
struct SlowCorpus {
    TemporaryFolder folder;
    fs::path takes = folder / "takes";
    StoreOnDisk store{folder / "store"};

    SlowCorpus() { generate_corpus(takes, 16000, 2); }
    JobChain submit(std::vector<std::string> submit_options = {}) const {
        return {takes, store.path(), slow_clustering(std::move(submit_options))};
    }
    /// The ranks of the run, when there is something to go on from and more to do.
    std::vector<pid_t> ranks_at_work() const {
        wait_until([&] { return store.has_checkpoint(); });
        std::vector<pid_t> ranks = processes_on(store.path(), "reindex");
        REQUIRE(std::to_string(ranks.size()) == rank_count);
        return ranks;
    }
    std::string serial_digests() const { return ::serial_digests(takes, slow_clustering()); }
};

}  // namespace

TEST_CASE("three jobs publish what one process makes, whatever the folders are called", "[slurm]") {
    if (!SlurmCluster::find()) return;
    const TemporaryFolder folder;
    const fs::path corpus = folder / "it's a \"corpus\" $(x)", home = folder / "50 %j\nstores";
    generate_corpus(corpus, 24000, 3);
    const StoreOnDisk store(home / "store");
    std::vector<std::string> options = {"--node-scratch", folder.path().string()};
    options.insert(options.end(), few_clusters.begin(), few_clusters.end());
    const JobChain chain(corpus, store.path(), options);
    chain.require_published();
    CHECK(store.digests() == serial_digests(corpus, few_clusters));
    CHECK(contains(chain.log("reindex-" + chain.reindex), "not published"));
    CHECK_FALSE(fs::exists(store.run_folder()));
}

TEST_CASE("one quarantined take does not break the chain, and is told at its end", "[slurm]") {
    if (!SlurmCluster::find()) return;
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.add("good/good_2.amc", "no take\n");
    const StoreOnDisk store(corpus.store());
    const JobChain chain(corpus.path(), store.path(), {"--", "--clusters", "5"});
    const CommandResult ended = chain.wait();
    CHECK(ended.exit_code == some_quarantined);
    CHECK(contains(ended.output, "published; some takes are quarantined"));
    CHECK(JobChain::state(chain.reindex) == "COMPLETED");
    CHECK(clips_in(store.path()).at("good_2").state == "quarantined");
}

TEST_CASE("a killed task is reported, its dependents are cancelled, and submitting again finishes",
          "[slurm]") {
    if (!SlurmCluster::find()) return;
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 48000, 4);
    const StoreOnDisk store(folder / "store");
    {
        const JobChain chain(corpus, store.path(), few_clusters);
        std::vector<pid_t> tasks;
        wait_until([&] { return !(tasks = processes_on(store.path(), "ingest")).empty(); });
        for (const pid_t task : tasks) ::kill(task, SIGKILL);
        const CommandResult ended = chain.wait();
        INFO(ended.output);
        CHECK(ended.exit_code == killed);
        CHECK(contains(ended.output, "(ingest) failed: see " + store.name()));
        CHECK(contains(ended.output, "its dependents were cancelled"));
        CHECK(JobChain::state(chain.reindex) == "CANCELLED");
        CHECK(JobChain::state(chain.publish) == "CANCELLED");
        CHECK_FALSE(store.current());
    }
    const JobChain again(corpus, store.path(), few_clusters);
    again.require_published();
    CHECK(store.digests() == serial_digests(corpus, few_clusters));
}

TEST_CASE("a killed rank ends its job at once, and submitting again goes on", "[slurm]") {
    if (!SlurmCluster::find()) return;
    const SlowCorpus corpus;
    {
        const JobChain chain = corpus.submit();
        const HeldProcesses ranks(corpus.ranks_at_work());
        ::kill(ranks.ids().back(), SIGKILL);
        ranks.let_go();
        const CommandResult ended = chain.wait();
        INFO(ended.output);
        CHECK(ended.exit_code == killed);
        CHECK(contains(ended.output, "(reindex) failed: see " + corpus.store.name()));
        CHECK(JobChain::state(chain.publish) == "CANCELLED");
    }
    const JobChain again = corpus.submit();
    again.require_published();
    CHECK(contains(again.log("reindex-" + again.reindex), "goes on after iteration"));
    CHECK(corpus.store.digests() == corpus.serial_digests());
}

TEST_CASE("a job whose node crashes begins anew, where it was interrupted", "[slurm]") {
    const auto cluster = SlurmCluster::find();
    if (!cluster) return;
    const SlowCorpus corpus;
    const JobChain chain = corpus.submit();
    const HeldProcesses ranks(corpus.ranks_at_work());
    const std::string node = SlurmCluster::first_node(JobChain::nodes(chain.reindex));
    cluster->crash(node);
    ranks.let_go();
    wait_until([&] { return JobChain::state(chain.reindex) != "COMPLETING"; });
    cluster->mend(node);
    chain.require_published();
    const std::string log = chain.log("reindex-" + chain.reindex);
    CHECK(contains(log, "start 2"));
    CHECK(contains(log, "goes on after iteration"));
    CHECK(corpus.store.digests() == corpus.serial_digests());
}

TEST_CASE("warned of its time limit, a job keeps its work and is requeued", "[slurm]") {
    if (!SlurmCluster::find()) return;
    const SlowCorpus corpus;
    const JobChain chain = corpus.submit();
    const HeldProcesses ranks(corpus.ranks_at_work());
    // As Slurm does before the limit (--signal): the steps, not the script.
    ask({"scancel", "--signal=TERM", chain.reindex});
    ranks.let_go_into(SIGTERM);
    chain.require_published();
    const std::string log = chain.log("reindex-" + chain.reindex);
    CHECK(contains(log, "interrupted; requeue 1 of at most 5"));
    CHECK(contains(log, "goes on after iteration"));
    CHECK(corpus.store.digests() == corpus.serial_digests());
}

TEST_CASE("a job that is cancelled stays cancelled, and submitting again goes on", "[slurm]") {
    if (!SlurmCluster::find()) return;
    const SlowCorpus corpus;
    {
        const JobChain chain = corpus.submit();
        const HeldProcesses ranks(corpus.ranks_at_work());
        ask({"scancel", chain.reindex});
        ranks.let_go_into(SIGTERM);
        const CommandResult ended = chain.wait();
        CHECK(ended.exit_code == interrupted);
        CHECK(JobChain::state(chain.reindex) == "CANCELLED");
        CHECK_FALSE(contains(chain.log("reindex-" + chain.reindex), "requeue"));
    }
    const JobChain again = corpus.submit();
    again.require_published();
    CHECK(contains(again.log("reindex-" + again.reindex), "goes on after iteration"));
}

TEST_CASE("a job that is interrupted more often than is allowed fails clearly", "[slurm]") {
    if (!SlurmCluster::find()) return;
    const SlowCorpus corpus;
    const JobChain chain = corpus.submit({"--max-requeues", "1", "--time", "7"});
    const std::string name = "reindex-" + chain.reindex;
    for (const std::string& job : {chain.ingest, chain.reindex, chain.publish}) {
        CHECK(ask({"squeue", "-h", "-t", "all", "-j", job, "-o", "%l"}).starts_with("7:00"));
    }
    for (const char* start : {"start 1", "start 2"}) {
        wait_until([&] {
            if (!corpus.store.has_checkpoint()) return false;  // there may be no log yet
            const std::string log = chain.log(name);
            const size_t at = log.find(start);
            return at != std::string::npos &&
                   contains(log.substr(at), "pose_clusters.h5: to be made");
        });
        const HeldProcesses ranks(corpus.ranks_at_work());
        ask({"scancel", "--signal=TERM", chain.reindex});
        ranks.let_go_into(SIGTERM);
    }
    const CommandResult ended = chain.wait();
    CHECK(ended.exit_code == interrupted);
    CHECK(contains(ended.output, "job " + chain.reindex + " (reindex) failed: see"));
    CHECK(contains(chain.log(name), "interrupted once more after 1 requeues"));
    CHECK(JobChain::state(chain.publish) == "CANCELLED");
}
