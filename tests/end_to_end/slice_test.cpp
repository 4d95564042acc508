// The frames of a corpus, read by several tasks, and published when all are there (design §6).
#include "store_on_disk.h"
#include "support/temporary_folder.h"
#include "takes.h"

namespace {

constexpr int nothing_usable = 65;

}  // namespace

TEST_CASE("slices make what a whole run makes", "[slices]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 24000, 3);
    const StoreOnDisk whole(folder / "whole"), store(folder / "store");
    require_program(reindex(corpus, whole.path(), {"--only", "frames"}));
    const auto ingest = [&](const std::string& slice) {
        std::vector<std::string> words = reindex(corpus, store.path(), {"--slice", slice});
        words[0] = "ingest";
        return program(words);
    };
    // Side by side, as tasks of an array.
    Process first(ingest("1/3")), second(ingest("2/3"));
    CHECK(first.wait().exit_code == 0);
    CHECK(second.wait().exit_code == 0);
    const CommandResult early = require_program({"publish", store.name()}, nothing_usable);
    CHECK(contains(early.errors, "frames are incomplete; run the missing ingest slices"));
    CHECK_FALSE(store.current());

    Process third(ingest("3/3"));
    CHECK(third.wait().exit_code == 0);
    const CommandResult published = require_program({"publish", store.name()});
    CHECK(contains(published.errors, "features: not complete, left out"));
    CHECK(store.artifact_bytes() == whole.artifact_bytes());
    CHECK(store.digests() == whole.digests());
    CHECK(contains(require_program({"publish", store.name()}).output, "up to date"));

    const RunLog rest(require_program(reindex(corpus, store.path())).errors);
    CHECK(rest.reused == whole.artifacts());
    CHECK(contains(require_program({"publish", store.name()}, nothing_usable).errors,
                   "no run in progress"));
}

TEST_CASE("an ingest that was killed is not published as if it were whole", "[slices]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 24000, 3);
    const StoreOnDisk store(folder / "store");
    std::vector<std::string> words = reindex(corpus, store.path());
    words[0] = "ingest";
    Process ingest(program(words));
    wait_until([&] { return fs::exists(store.run_folder() / "run.json") || ingest.ended(); });
    ingest.signal(SIGKILL);
    REQUIRE(ingest.wait().signal == SIGKILL);
    CHECK(contains(require_program({"publish", store.name()}, nothing_usable).errors,
                   "frames are incomplete"));
    CHECK_FALSE(store.current());
    require_program(words);
    require_program({"publish", store.name()});
    CHECK(run_program({"verify", store.name()}).exit_code == 0);
}
