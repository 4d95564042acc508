// One corpus and one set of options: one result, however it is come by (design §5).
#include "store_on_disk.h"
#include "support/temporary_folder.h"
#include "support/test_corpus.h"
#include "takes.h"

namespace {

struct Way {
    std::string threads, shard_frames;
};

std::string digests_of(const fs::path& corpus, const fs::path& store, const Way& way,
                       std::vector<std::string> more) {
    more.insert(more.end(), {"--threads", way.threads, "--shard-frames", way.shard_frames});
    require_program(reindex(corpus, store, more));
    return StoreOnDisk(store).digests();
}

std::string name_of(const Way& way) {
    return way.threads + " threads, shards of " + way.shard_frames + " frames";
}

}  // namespace

TEST_CASE("neither threads nor the size of shards change a digest, nor threads a byte",
          "[digest]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 24000, 3);
    for (const std::string partition : {"none", "subject"}) {
        INFO("--partition " << partition);
        const std::vector<std::string> options = {"--partition", partition, "--corpus-graph", "on"};
        const StoreOnDisk first(folder / (partition + "-first"));
        const std::string expected = digests_of(corpus, first.path(), {"1", "8192"}, options);
        REQUIRE(first.artifacts("frames-").size() > 1);
        const auto bytes = first.artifact_bytes();

        for (const Way& way : {Way{"2", "8192"}, Way{"7", "8192"}, Way{"1", "65536"},
                               Way{"2", "65536"}, Way{"7", "65536"}}) {
            INFO(name_of(way));
            const StoreOnDisk store(folder / (partition + way.threads + "-" + way.shard_frames));
            CHECK(digests_of(corpus, store.path(), way, options) == expected);
            if (way.shard_frames == "8192") {
                CHECK(store.artifact_bytes() == bytes);
            } else {
                CHECK(store.artifacts() != first.artifacts());  // else nothing was compared
            }
        }
    }
}

TEST_CASE("the two partitions differ, so that equal digests mean something", "[digest]") {
    const TemporaryFolder folder;
    generate_corpus(folder / "takes", 6000, 2);
    const Way way{"2", "8192"};
    CHECK(digests_of(folder / "takes", folder / "none", way, {"--partition", "none"}) !=
          digests_of(folder / "takes", folder / "subject", way, {"--partition", "subject"}));
}

TEST_CASE("a take that comes and goes leaves the digests of a fresh build", "[digest]") {
    const TemporaryFolder folder;
    const fs::path corpus = folder / "takes";
    generate_corpus(corpus, 24000, 3);
    const StoreOnDisk store(folder / "store");
    require_program(reindex(corpus, store.path()));
    const std::string before = store.digests();

    const fs::path guest = corpus / "02" / "02_77.amc";
    write_text(guest, shifted_take(text_of(corpus / "02" / "02_01.amc"), 40));
    require_program(reindex(corpus, store.path()));
    const std::string with_guest = store.digests();
    CHECK(with_guest != before);
    require_program(reindex(corpus, folder / "fresh"));
    CHECK(StoreOnDisk(folder / "fresh").digests() == with_guest);

    fs::remove(guest);
    require_program(reindex(corpus, store.path()));
    CHECK(store.digests() == before);
}

TEST_CASE("on real takes, neither threads nor the size of shards change a digest", "[digest]") {
    const auto real = test_corpus();
    if (!real) return;
    const TemporaryFolder folder;
    const std::vector<std::string> options = {"--clusters",       "40",  "--max-iterations", "3",
                                              "--leaf-tolerance", "120", "--corpus-graph",   "on"};
    const auto digests = [&](const Way& way) {
        return digests_of(*real / "cmu", folder / (way.threads + "-" + way.shard_frames), way,
                          options);
    };
    const std::string expected = digests({"1", "8192"});
    CHECK(digests({"2", "65536"}) == expected);
    CHECK(digests({"7", "65536"}) == expected);
    const StoreOnDisk store(folder / "7-65536");
    CHECK(contains(require_program({"info", store.name()}).output,
                   "211 indexed, 0 quarantined, 331893 frames"));
}
