// Runs that are killed or stopped: nothing half-made is ever seen, and what was done is not done
// again (design §4).
#include <random>

#include "store_on_disk.h"
#include "support/temporary_folder.h"
#include "takes.h"

namespace {

constexpr int interrupted = 75;

void sleep_seconds(double seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// `current` is absent or a whole generation.
void require_whole(const StoreOnDisk& store) {
    if (!store.current()) return;
    const CommandResult verified = run_program({"verify", store.name()});
    INFO(verified.errors);
    REQUIRE(verified.exit_code == 0);
}

/// EM takes long here, so that a signal finds it at work.
std::vector<std::string> slow_clustering(const fs::path& corpus, const fs::path& store) {
    return reindex(corpus, store,
                   {"--clusters", "400", "--min-gain", "1e-12", "--max-iterations", "150"});
}

/// The command that an interrupted run told its user to type.
std::string resume_command(const std::string& errors) {
    const std::string mark = "To resume: ";
    const size_t at = errors.find(mark);
    REQUIRE(at != std::string::npos);
    return errors.substr(at + mark.size(), errors.find('\n', at) - at - mark.size());
}

}  // namespace

TEST_CASE("killed at any moment, a run is resumed to the same digests", "[resume]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes", guest = corpus / "01" / "01_88.amc";
    generate_corpus(corpus, 16000, 2);

    // Every other kill meets a store that already has a generation, of one take less.
    const StoreOnDisk earlier(folder / "earlier");
    require_program(reindex(corpus, earlier.path()));
    write_text(guest, shifted_take(text_of(corpus / "01" / "01_01.amc"), 25));
    const StoreOnDisk whole(folder / "whole");
    const double duration = require_program(reindex(corpus, whole.path())).seconds;
    const std::string expected = whole.digests();

    std::mt19937 random(20);
    std::uniform_real_distribution<double> somewhere(0, 1);
    constexpr int moments = 20;
    int killed = 0;
    for (int i = 0; i < moments; ++i) {
        const double moment = duration * (i + somewhere(random)) / moments;
        INFO("killed after " << moment << " of " << duration << " s, moment " << i);
        const StoreOnDisk store(folder / ("store-" + std::to_string(i)));
        if (i % 2)
            fs::copy(earlier.path(), store.path(),
                     fs::copy_options::recursive | fs::copy_options::copy_symlinks);
        Process process(program(reindex(corpus, store.path())));
        sleep_seconds(moment);
        process.signal(SIGKILL);
        killed += process.wait().signal == SIGKILL;
        require_whole(store);

        require_program(reindex(corpus, store.path()));
        CHECK(store.digests() == expected);
        CHECK(store.artifact_bytes() == whole.artifact_bytes());
        CHECK_FALSE(fs::exists(store.run_folder()));
        // A generation that the killed run completed but did not make current may be left.
        for (const std::string& id : store.generations()) {
            CHECK(run_program({"verify", store.name(), "--generation", id}).exit_code == 0);
        }
        fs::remove_all(store.path());
    }
    CHECK(killed >= moments / 4);  // else hardly any run was caught at work
}

TEST_CASE("killed while it clusters, a run goes on after its last iteration", "[resume]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 12000, 2);
    const StoreOnDisk whole(folder / "whole"), store(folder / "store");
    require_program(slow_clustering(corpus, whole.path()));

    Process process(program(slow_clustering(corpus, store.path())));
    wait_until([&] { return store.has_checkpoint() || process.ended(); });
    process.signal(SIGKILL);
    REQUIRE(process.wait().signal == SIGKILL);

    const CommandResult resumed = require_program(slow_clustering(corpus, store.path()));
    CHECK(contains(resumed.errors, "goes on after iteration"));
    CHECK_FALSE(contains(resumed.errors, "goes on after iteration 0"));
    const RunLog log(resumed.errors);
    std::set<std::string> rest = store.artifacts("neighbors-");
    rest.merge(std::set<std::string>{"motion_strings.h5", "pose_clusters.h5", "bundles.h5",
                                     "bundle_graph.h5", "pose_hierarchy.h5", "signatures.h5",
                                     "segments.h5", "primitives.h5"});
    CHECK(log.names_made() == rest);
    CHECK(contains(resumed.errors, "reused from the run in progress"));
    CHECK(store.digests() == whole.digests());
    CHECK(store.artifact_bytes() == whole.artifact_bytes());
}

TEST_CASE("a damaged checkpoint is not gone on from", "[resume]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 6000, 1);
    const StoreOnDisk whole(folder / "whole"), store(folder / "store");
    require_program(slow_clustering(corpus, whole.path()));

    Process process(program(slow_clustering(corpus, store.path())));
    wait_until([&] { return store.has_checkpoint() || process.ended(); });
    process.signal(SIGKILL);
    REQUIRE(process.wait().signal == SIGKILL);
    for (const auto& entry : fs::directory_iterator(store.run_folder())) {
        if (entry.path().filename().string().rfind("checkpoint-", 0) != 0) continue;
        std::string bytes = text_of(entry.path());
        bytes[bytes.size() / 2] ^= 0x10;
        write_text(entry.path(), bytes);
    }
    const CommandResult resumed = require_program(slow_clustering(corpus, store.path()));
    CHECK_FALSE(contains(resumed.errors, "goes on after"));
    CHECK(store.digests() == whole.digests());
}

TEST_CASE("asked to stop, a run keeps its work and says how to resume", "[resume]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "it's takes";  // a name the printed command must quote
    generate_corpus(corpus, 12000, 2);
    const StoreOnDisk whole(folder / "whole");
    require_program(slow_clustering(corpus, whole.path()));

    for (const int signal : {SIGTERM, SIGINT}) {
        INFO("signal " << signal);
        const StoreOnDisk store(folder / ("store-" + std::to_string(signal)));
        Process process(program(slow_clustering(corpus, store.path())));
        wait_until([&] { return store.has_checkpoint() || process.ended(); });
        process.signal(signal);
        const CommandResult stopped = process.wait();
        INFO(stopped.errors);
        REQUIRE(stopped.exit_code == interrupted);
        CHECK_FALSE(store.current());

        const CommandResult resumed = run({.words = {"sh", "-c", resume_command(stopped.errors)}});
        INFO(resumed.errors);
        REQUIRE(resumed.exit_code == 0);
        CHECK(contains(resumed.errors, "goes on after iteration"));
        CHECK(RunLog(resumed.errors).reused.size() == whole.artifacts("f").size());
        CHECK(store.digests() == whole.digests());
    }
}

TEST_CASE("asked to stop at any moment, a run answers with 75 or has finished", "[resume]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 16000, 2);
    const StoreOnDisk whole(folder / "whole");
    const double duration = require_program(reindex(corpus, whole.path())).seconds;

    std::mt19937 random(6);
    std::uniform_real_distribution<double> somewhere(0, 1);
    constexpr int moments = 6;
    for (int i = 0; i < moments; ++i) {
        const StoreOnDisk store(folder / ("store-" + std::to_string(i)));
        Process process(program(reindex(corpus, store.path())));
        // Not before the program has got so far as to watch for signals.
        wait_until([&] { return fs::exists(store.path()) || process.ended(); });
        sleep_seconds(duration * (i + somewhere(random)) / moments);
        process.signal(SIGTERM);
        const CommandResult stopped = process.wait();
        INFO(stopped.errors);
        REQUIRE((stopped.exit_code == interrupted || stopped.exit_code == 0));
        require_whole(store);
        require_program(reindex(corpus, store.path()));
        CHECK(store.digests() == whole.digests());
    }
}
