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
    // Nothing else depends on the partition.
    if (partition == "none") {
        words.insert(words.end(), {"--only", "frames,features,pose_clusters,motion_strings"});
    }
    words.insert(words.begin(), KINETOME_PROGRAM);
    const CommandResult result = run(as_ranks(ranks, words));
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    const std::string digests = StoreOnDisk(store).digests();
    fs::remove_all(store);
    return digests;
}

}  // namespace

TEST_CASE("on real takes, neither threads nor ranks nor shards change a digest", "[mpi]") {
    const auto real = test_corpus();
    if (!real) return;
    const TemporaryFolder folder;
    // Partitions of both kinds: worked on by all ranks together, and by one rank each.
    for (const std::string partition : {"none", "subject"}) {
        const auto digests = [&](int threads, int ranks, int shard_frames) {
            return digests_of(*real / "cmu", folder / "store", threads, ranks, shard_frames,
                              partition);
        };
        const std::string expected = digests(1, 1, 65536);
        for (const int threads : {1, 2}) {
            for (const int ranks : {1, 2, 3, 4}) {
                // Every combination for one kind of partition, the corners for the other.
                if (partition == "none" && (ranks == 2 || threads == 2)) continue;
                for (const int shard_frames : {8192, 65536}) {
                    INFO(threads << " threads, " << ranks << " ranks, shards of " << shard_frames);
                    CHECK(digests(threads, ranks, shard_frames) == expected);
                }
            }
        }
    }
}
