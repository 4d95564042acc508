// The program as the ranks of an MPI job: one summary, one error, one exit code.
#include "end_to_end/small_corpus.h"
#include "end_to_end/store_on_disk.h"
#include "mpirun.h"

namespace {

constexpr int usage = 64, interrupted = 75;

Command program_as_ranks(int ranks, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), KINETOME_PROGRAM);
    return as_ranks(ranks, std::move(arguments));
}

CommandResult require_ranks(int ranks, std::vector<std::string> arguments, int expected = 0) {
    CommandResult result = run(program_as_ranks(ranks, std::move(arguments)));
    INFO(result.errors);
    REQUIRE(result.exit_code == expected);
    return result;
}

size_t times_in(const std::string& text, const std::string& part) {
    size_t times = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++times;
    }
    return times;
}

/// Process ids of the ranks that an mpirun started, rank 0 first.
std::vector<pid_t> ranks_of(const Process& mpirun) {
    const std::string id = std::to_string(mpirun.id());
    std::ifstream children("/proc/" + id + "/task/" + id + "/children");
    std::vector<pid_t> ranks;
    for (pid_t rank; children >> rank;) ranks.push_back(rank);
    return ranks;
}

/// A run of many iterations of EM, and what it must come to.
struct SlowRun {
    TemporaryFolder folder;
    fs::path corpus = folder / "takes";
    StoreOnDisk whole{folder / "whole"}, store{folder / "store"};

    SlowRun() {
        generate_corpus(corpus, 12000, 2);
        require_program(words(whole));
    }
    std::vector<std::string> words(const StoreOnDisk& into) const {
        return reindex(corpus, into.path(),
                       {"--clusters", "400", "--min-gain", "1e-12", "--max-iterations", "150",
                        "--threads", "1"});
    }
    Command as_ranks(int ranks) const { return program_as_ranks(ranks, words(store)); }
    bool has_checkpoint() const {
        if (!fs::exists(store.run_folder())) return false;
        for (const auto& entry : fs::directory_iterator(store.run_folder())) {
            const std::string name = entry.path().filename().string();
            if (name.starts_with("checkpoint-") && !contains(name, ".writing-")) return true;
        }
        return false;
    }
    void wait_for_checkpoint(Process& mpirun) const {
        wait_until([&] { return has_checkpoint() || mpirun.ended(); });
        REQUIRE_FALSE(mpirun.ended());
    }
};

}  // namespace

TEST_CASE("ranks make the store that one process makes, and print one summary", "[mpi]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.add_take("good/good_2.amc");
    corpus.reindex(0);
    const StoreOnDisk whole(corpus.store());
    for (const int ranks : {1, 2, 3}) {
        INFO(ranks << " ranks");
        const StoreOnDisk store(corpus.folder() / ("store-" + std::to_string(ranks)));
        const fs::path log = corpus.folder() / ("log-" + std::to_string(ranks));
        const CommandResult indexed = require_ranks(
            ranks,
            reindex(corpus.path(), store.path(), {"--clusters", "5", "--log-file", log.string()}));
        CHECK(times_in(indexed.output, "whole run") == 1);
        CHECK(times_in(indexed.output, "generation ") == 1);
        CHECK(times_in(indexed.errors, "published generation") == 1);
        CHECK(text_of(log) == indexed.errors);
        CHECK(store.digests() == whole.digests());
        CHECK(store.artifact_bytes() == whole.artifact_bytes());
    }
}

TEST_CASE("a command that needs no ranks prints once under mpirun", "[mpi]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.add("good/good_2.amc", "nonsense");
    corpus.reindex(3);
    const std::string store = corpus.store().string();
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"info", store}, {"verify", store, "--digest"}, {"--help"}, {"info", "--help"}}) {
        INFO(joined(words));
        CHECK(require_ranks(3, words).output == require_program(words).output);
    }
}

TEST_CASE("all ranks answer with the code of some takes quarantined", "[mpi]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.add("good/good_2.amc", "nonsense");
    const auto words = reindex(corpus.path(), corpus.store(), {"--clusters", "5"});
    CHECK(times_in(require_ranks(2, words, 3).output, "quarantined: ") == 1);
}

TEST_CASE("under mpirun an error is printed once", "[mpi]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const std::string takes = corpus.path().string(), store = corpus.store().string();
    struct Mistake {
        std::vector<std::string> words;
        std::string named;
        int code;
    };
    for (const Mistake& mistake : std::vector<Mistake>{
             {{"reindex", takes, "--store", store, "--colour", "3"}, "--colour", usage},
             {{"reindex", takes, "--store", store, "--clusters", "many"}, "'many'", usage},
             {{"reindex", takes, "--store", store, "--memory", "much"}, "'much'", usage},
             {{"reindx", takes}, "'reindx'", usage},
             {{"reindex", takes + "/none", "--store", store}, "takes/none: ", 65},
             {{"info", store}, "there is no store", 74},
         }) {
        INFO(joined(mistake.words));
        const CommandResult refused = require_ranks(2, mistake.words, mistake.code);
        CHECK(times_in(refused.errors, mistake.named) == 1);
        CHECK(refused.output.empty());
    }
}

TEST_CASE("ranks that are given different commands refuse to start", "[mpi]") {
    const std::vector<std::string> slices = {
        "sh", "-c",
        "exec \"$0\" ingest takes --store store --slice $((OMPI_COMM_WORLD_RANK + 1))/2",
        KINETOME_PROGRAM};
    const CommandResult refused = run(as_ranks(2, slices));
    CHECK(refused.exit_code == usage);
    CHECK(times_in(refused.errors, "different commands") == 1);
    CHECK(contains(refused.errors, "rank 1: "));
}

TEST_CASE("a rank killed ends the job, and the same command finishes the work", "[mpi]") {
    const SlowRun slow;
    for (const size_t victim : {0u, 1u}) {
        INFO("rank " << victim << " is killed");
        fs::remove_all(slow.store.path());
        Process mpirun(slow.as_ranks(2));
        slow.wait_for_checkpoint(mpirun);
        const std::vector<pid_t> ranks = ranks_of(mpirun);
        REQUIRE(ranks.size() == 2);
        ::kill(ranks[victim], SIGKILL);
        CHECK(mpirun.wait().exit_code == 128 + SIGKILL);

        const CommandResult resumed = run(slow.as_ranks(2));
        INFO(resumed.errors);
        REQUIRE(resumed.exit_code == 0);
        CHECK(slow.store.digests() == slow.whole.digests());
    }
}

TEST_CASE("asked to stop through mpirun, all ranks answer with 75 and one says how to resume",
          "[mpi]") {
    const SlowRun slow;
    Process mpirun(slow.as_ranks(3));
    slow.wait_for_checkpoint(mpirun);
    mpirun.signal(SIGUSR1);  // which mpirun passes on
    const CommandResult stopped = mpirun.wait();
    INFO(stopped.errors);
    REQUIRE(stopped.exit_code == interrupted);
    CHECK(times_in(stopped.errors, "To resume, on any number of ranks: ") == 1);
    CHECK_FALSE(slow.store.current());

    const CommandResult resumed = require_program(slow.words(slow.store));
    CHECK(contains(resumed.errors, "goes on after iteration"));
    CHECK(slow.store.digests() == slow.whole.digests());
}

TEST_CASE("when one rank is asked to stop, all stop", "[mpi]") {
    const SlowRun slow;
    Process mpirun(slow.as_ranks(2));
    slow.wait_for_checkpoint(mpirun);
    ::kill(ranks_of(mpirun).at(0), SIGTERM);
    const CommandResult stopped = mpirun.wait();
    INFO(stopped.errors);
    CHECK(stopped.exit_code == interrupted);
    CHECK(times_in(stopped.errors, "To resume") == 1);
}
