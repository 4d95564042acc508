// Threads, ranks and shards change nothing, on real takes (design §5).
#include "end_to_end/store_on_disk.h"
#include "end_to_end/takes.h"
#include "mpirun.h"
#include "support/temporary_folder.h"
#include "support/test_corpus.h"

namespace {

std::string digests_of(const fs::path& corpus, const fs::path& store, int threads, int ranks,
                       int shard_frames, const std::string& partition) {
    std::vector<std::string> words =
        reindex(corpus, store,
                {"--threads", std::to_string(threads), "--shard-frames",
                 std::to_string(shard_frames), "--partition", partition, "--clusters", "40",
                 "--max-iterations", "3", "--leaf-tolerance", "120", "--corpus-graph", "on"});
    words.insert(words.begin(), KINETOME_PROGRAM);
    const CommandResult result = run(as_ranks(ranks, words));
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    const std::string digests = StoreOnDisk(store).digests();
    fs::remove_all(store);
    return digests;
}

}  // namespace

TEST_CASE("on real takes of three bodies, neither threads nor ranks nor shards change a digest",
          "[mpi]") {
    const auto real = test_corpus();
    if (!real) return;
    const TemporaryFolder folder;
    for (const char* const subject : {"02", "13", "86"}) {
        fs::create_directories(folder / "takes");
        fs::copy(*real / "cmu" / subject, folder / "takes" / subject, fs::copy_options::recursive);
    }
    // Partitions of both kinds: worked on by all ranks together, and by one rank each.
    for (const std::string partition : {"none", "subject"}) {
        const auto digests = [&](int threads, int ranks, int shard_frames) {
            return digests_of(folder / "takes", folder / "store", threads, ranks, shard_frames,
                              partition);
        };
        const std::string expected = digests(1, 1, 65536);
        for (const int threads : {1, 2}) {
            for (const int ranks : {1, 2, 3, 4}) {
                for (const int shard_frames : {8192, 65536}) {
                    INFO(threads << " threads, " << ranks << " ranks, shards of " << shard_frames);
                    CHECK(digests(threads, ranks, shard_frames) == expected);
                }
            }
        }
    }
}

TEST_CASE("three ranks index all real takes like one process", "[mpi]") {
    const auto real = test_corpus();
    if (!real) return;
    const TemporaryFolder folder;
    const auto digests = [&](int threads, int ranks, int shard_frames) {
        return digests_of(*real / "cmu", folder / "store", threads, ranks, shard_frames, "subject");
    };
    CHECK(digests(2, 3, 8192) == digests(2, 1, 65536));
}
