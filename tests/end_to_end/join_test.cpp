// A run that is opened once and carried out in parts: tasks of an array, a job on top, publication.
#include "kinetome/stages/reindex.h"
#include "small_corpus.h"
#include "store_on_disk.h"

namespace {

constexpr int some_quarantined = 3, usage = 64, nothing_usable = 65, cannot_create = 73, io = 74;

/// With the options of reindex() in program.h.
void open(const fs::path& corpus, const fs::path& store) {
    kinetome::ReindexRequest request;
    request.corpus = corpus;
    request.store = store;
    request.options.frames.shard_frames = 8192;
    request.options.pose_clusters.clusters = 60;
    request.resources = kinetome::granted_resources(2, std::nullopt);
    kinetome::open_run(request, kinetome::Log(), {});
}

std::vector<std::string> join(const std::string& command, const fs::path& corpus,
                              const fs::path& store, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {command,  corpus.string(), "--store", store.string(),
                                      "--join", "--threads",     "1"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

std::vector<std::string> slice(const fs::path& corpus, const fs::path& store,
                               const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = reindex(corpus, store, more);
    words[0] = "ingest";
    words.insert(words.end(), {"--slice", "1/2"});
    return words;
}

/// Of the run in progress.
std::string record_in(const StoreOnDisk& store) {
    return text_of(store.run_folder() / "run.json");
}

}  // namespace

TEST_CASE("the parts of a run that was opened make what one command makes", "[join]") {
    const TemporaryFolder folder, scratch;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 24000, 3);
    const StoreOnDisk whole(folder / "whole"), store(folder / "store");
    require_program(reindex(corpus, whole.path()));

    open(corpus, store.path());
    CHECK_FALSE(store.current());
    // Not surveyed again: what came later waits for the next run.
    write_text(corpus / "01" / "01_88.amc", "not there when the run was opened");
    Process first(program(join("ingest", corpus, store.path(), {"--slice", "1/2"})));
    // One part on another disk, which makes no difference.
    const std::vector<std::string> elsewhere = {"--node-scratch", scratch.path().string()};
    require_program(
        join("ingest", corpus, store.path(), {"--slice", "2/2", elsewhere[0], elsewhere[1]}));
    CHECK(first.wait().exit_code == 0);

    const CommandResult rest =
        require_program(join("reindex", corpus, store.path(),
                             {"--no-publish", "--clusters", "60", elsewhere[0], elsewhere[1]}));
    CHECK(contains(rest.output, "not published: `kinetome publish STORE`"));
    CHECK(RunLog(rest.errors).reused == whole.artifacts("frames"));
    CHECK_FALSE(store.current());
    CHECK(fs::is_empty(scratch.path()));
    require_program({"publish", store.name()});
    CHECK(store.artifact_bytes() == whole.artifact_bytes());
    CHECK(store.digests() == whole.digests());
    CHECK_FALSE(clips_in(store.path()).count("01_88"));
}

TEST_CASE("a run that is opened again goes on with the finished work of the one before", "[join]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 16000, 2);
    const StoreOnDisk store(folder / "store");
    open(corpus, store.path());
    require_program(join("ingest", corpus, store.path()));
    open(corpus, store.path());
    const RunLog log(require_program(join("reindex", corpus, store.path())).errors);
    CHECK(log.reused == store.artifacts("frames"));
}

TEST_CASE("only the run that was opened can be joined: no other folder, option or take", "[join]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const StoreOnDisk store(corpus.store());
    const auto refused = [&](const std::vector<std::string>& words, int code) {
        return require_program(words, code).errors;
    };
    CHECK(contains(refused(join("reindex", corpus.path(), store.path()), io), "there is no store"));
    CHECK_FALSE(fs::exists(store.path()));
    corpus.reindex(0);
    const std::string advice =
        "`kinetome plan " + corpus.path().string() + " --store " + store.name() + " --open`";
    for (const std::string command : {"ingest", "reindex"}) {
        const std::string errors =
            refused(join(command, corpus.path(), store.path()), nothing_usable);
        CHECK(contains(errors, "no run is open: " + advice));
    }
    CHECK_FALSE(fs::exists(store.run_folder()));

    corpus.add_take("good/good_2.amc");
    open(corpus.path(), store.path());
    const std::string record = record_in(store);
    const fs::path other = corpus.folder() / "other";
    fs::create_directory(other);
    CHECK(contains(refused(join("ingest", other, store.path()), usage),
                   "is not the folder that the run was opened for"));
    CHECK(contains(refused(join("reindex", corpus.path(), store.path(), {"--seed", "7"}), usage),
                   "seed is '7', but the run was opened with '1'"));
    const fs::path config = corpus.folder().write("config.toml", "clusters = 61\n");
    CHECK(
        contains(refused(join("reindex", corpus.path(), store.path(), {"--config", config}), usage),
                 "clusters is '61', but the run was opened with '60'"));
    corpus.add_take("good/good_2.amc");
    CHECK(contains(refused(join("ingest", corpus.path(), store.path()), io),
                   "good_2.amc: changed since the run began: open the run again with " + advice));
    fs::remove(corpus.path() / "good/good_2.amc");
    CHECK(contains(refused(join("ingest", corpus.path(), store.path()), io), advice));
    CHECK(record_in(store) == record);
}

TEST_CASE("a slice does not change the run that other slices are at work for", "[join]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    const StoreOnDisk store(corpus.store());
    open(corpus.path(), store.path());
    const std::string record = record_in(store);
    {
        kinetome::StoreDirectory directory = kinetome::StoreDirectory::open(store.path());
        const kinetome::StoreLock at_work = directory.lock_slice("slice-2-of-2");
        const auto refused = [&](const std::vector<std::string>& words) {
            CHECK(contains(require_program(words, cannot_create).errors,
                           "is at work for other takes or options"));
            CHECK(record_in(store) == record);
        };
        refused(slice(corpus.path(), store.path(), {"--amc-rate", "60"}));
        require_program(slice(corpus.path(), store.path()));
        CHECK(record_in(store) == record);
        corpus.add_take("good/good_2.amc");
        refused(slice(corpus.path(), store.path()));
    }
    const CommandResult alone = require_program(slice(corpus.path(), store.path()));
    CHECK(contains(alone.errors, "the run in progress was for other takes or options"));
    CHECK(record_in(store) != record);
}

TEST_CASE("every part of a run tells that a take was quarantined", "[join]") {
    SmallCorpus corpus;
    corpus.add_good_take();
    corpus.add("good/good_2.amc", "no take\n");
    open(corpus.path(), corpus.store());
    require_program(join("ingest", corpus.path(), corpus.store()), some_quarantined);
    require_program(join("reindex", corpus.path(), corpus.store(), {"--no-publish"}),
                    some_quarantined);
    require_program({"publish", corpus.store().string()}, some_quarantined);
}
