// One run on several ranks (threads of this process here): the store of a single one.
#include <fmt/format.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <string>
#include <thread>

#include "kinetome/stages/open_store.h"
#include "kinetome/stages/reindex.h"
#include "kinetome/stages/verification.h"
#include "kinetome/store/store_directory.h"
#include "kinetome/synthesis/corpus_generator.h"
#include "support/temporary_folder.h"
#include "support/thread_ranks.h"

using namespace kinetome;
namespace fs = std::filesystem;

namespace {

ReindexRequest request_for(const fs::path& corpus, const fs::path& store) {
    ReindexRequest request;
    request.corpus = corpus;
    request.store = store;
    request.options.frames.shard_frames = group_frames;
    request.options.pose_clusters.clusters = 30;
    request.options.pose_clusters.mixture.max_iterations = 5;
    request.resources.threads = 1;
    request.resources.memory_bytes = uint64_t{2} << 30;
    return request;
}

RunSummary reindex_on(int count, const ReindexRequest& request, const StopToken& stop = {}) {
    RunSummary summary;
    run_as_ranks(count, [&](Communicator& ranks) {
        ReindexRequest mine = request;
        mine.ranks = &ranks;
        RunSummary result = reindex(mine, Log(), stop);
        if (ranks.is_root()) summary = std::move(result);
    });
    return summary;
}

/// A rank that comes late out of every broadcast.
class LateCommunicator final : public Communicator {
  public:
    explicit LateCommunicator(Communicator& ranks) : ranks_(ranks) {}

    int rank() const override { return ranks_.rank(); }
    int size() const override { return ranks_.size(); }
    std::vector<std::string> gather_to_all(std::string bytes) override {
        return ranks_.gather_to_all(std::move(bytes));
    }
    std::vector<std::string> gather(std::string bytes) override {
        return ranks_.gather(std::move(bytes));
    }
    std::string broadcast(std::string bytes) override {
        std::string heard = ranks_.broadcast(std::move(bytes));
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        return heard;
    }
    std::string pass(int to, std::string bytes) override {
        return ranks_.pass(to, std::move(bytes));
    }
    std::vector<WorkList*> work_lists() override { return ranks_.work_lists(); }
    void check() override { ranks_.check(); }
    ExitCode fail(ExitCode code, const std::string& message) noexcept override {
        return ranks_.fail(code, message);
    }

  private:
    Communicator& ranks_;
};

std::string digests_of(const fs::path& path) {
    const OpenStore store(path);
    std::string text;
    for (const LogicalDigest& one : logical_digests(store.generation)) {
        text += fmt::format("{}/{} {}\n", one.artifact, one.dataset, one.digest.hex());
    }
    return text;
}

fs::path generated_corpus(const TemporaryFolder& folder) {
    generate_corpus({.frames = 40'000, .seed = 5, .subjects = 4}, folder / "takes", 2);
    return folder / "takes";
}

}  // namespace

TEST_CASE("a run on any number of ranks makes the store of one rank") {
    const TemporaryFolder folder;
    const fs::path corpus = generated_corpus(folder);
    for (const PartitionRule rule : {PartitionRule::none, PartitionRule::subject}) {
        ReindexRequest request = request_for(corpus, folder / fmt::format("alone-{}", int(rule)));
        request.options.partition.rule = rule;
        const RunSummary alone = reindex(request, Log(), {});
        REQUIRE(alone.stages.at(0).made > 2);
        const std::string expected = digests_of(request.store);
        for (const int count : {2, 3, 7}) {
            request.store = folder / fmt::format("on-{}-{}", count, int(rule));
            const RunSummary summary = reindex_on(count, request);
            CHECK(digests_of(request.store) == expected);
            CHECK(summary.publication.catalog.clips.size() ==
                  alone.publication.catalog.clips.size());
            CHECK(summary.stages.at(0).made == alone.stages.at(0).made);
            CHECK(reindex_on(count, request).publication.up_to_date);
        }
    }
}

TEST_CASE("a store that is up to date is not published while a late rank still opens the run") {
    const TemporaryFolder folder;
    generate_corpus({.frames = 600, .seed = 5, .subjects = 1}, folder / "takes", 1);
    const ReindexRequest request = request_for(folder / "takes", folder / "store");
    reindex(request, Log(), {});
    run_as_ranks(2, [&](Communicator& ranks) {
        LateCommunicator late(ranks);
        ReindexRequest mine = request;
        mine.ranks = ranks.is_root() ? &ranks : &late;
        const RunSummary summary = reindex(mine, Log(), {});
        if (ranks.is_root() && !summary.publication.up_to_date) {
            throw std::logic_error("what was up to date is made again");
        }
    });
    CHECK_FALSE(fs::exists(StoreDirectory::open(request.store).run_folder()));
}

TEST_CASE("a run that several ranks left is finished by another number of them") {
    const TemporaryFolder folder;
    const fs::path corpus = generated_corpus(folder);
    ReindexRequest request = request_for(corpus, folder / "alone");
    reindex(request, Log(), {});
    const std::string expected = digests_of(request.store);

    request.store = folder / "interrupted";
    request.only = {"frames"};
    request.publish = false;
    reindex_on(3, request);
    request.only = {};
    request.publish = true;
    std::atomic<bool> stop{true};
    CHECK_THROWS_AS(reindex_on(2, request, StopToken(stop)), Interrupted);
    const RunSummary summary = reindex_on(5, request);
    CHECK(summary.stages.at(0).reused > 2);
    CHECK(digests_of(request.store) == expected);
}

TEST_CASE("ranks that start with a store left by one rank reuse all of it") {
    const TemporaryFolder folder;
    ReindexRequest request = request_for(generated_corpus(folder), folder / "store");
    reindex(request, Log(), {});
    request.options.pose_clusters.clusters = 25;
    const RunSummary summary = reindex_on(3, request);
    CHECK(summary.stages.at(0).made == 0);
    CHECK(summary.stages.at(1).made == 0);
    CHECK(summary.stages.at(2).made == 1);
    ReindexRequest fresh = request;
    fresh.store = folder / "fresh";
    reindex(fresh, Log(), {});
    CHECK(digests_of(request.store) == digests_of(fresh.store));
}

TEST_CASE("too little memory is refused by every rank, telling how much is needed") {
    const TemporaryFolder folder;
    ReindexRequest request = request_for(generated_corpus(folder), folder / "store");
    request.resources.memory_bytes = 1 << 20;
    CHECK_THROWS_WITH(reindex_on(2, request), Catch::Contains("raise --memory"));
    request.resources.memory_bytes = uint64_t{2} << 30;
    CHECK(reindex_on(2, request).stages.at(0).reused > 2);
}

TEST_CASE("rows beyond the memory granted are read again, with the same result") {
    const TemporaryFolder folder;
    ReindexRequest request = request_for(generated_corpus(folder), folder / "ample");
    request.options.partition.rule = PartitionRule::none;
    reindex(request, Log(), {});
    const std::string expected = digests_of(request.store);
    // What fitting needs, and room for few rows: the message of the refusal tells how much that is.
    request.store = folder / "scarce";
    request.resources.memory_bytes = 1 << 20;
    uint64_t needed = 0;
    try {
        reindex(request, Log(), {});
    } catch (const UsageError& error) {
        const std::string text = error.what();
        needed = std::stoull(text.substr(text.find('(') + 1));
    }
    REQUIRE(needed > 1 << 20);
    request.resources.memory_bytes = needed + (uint64_t{4} << 20);
    reindex(request, Log(), {});
    CHECK(digests_of(request.store) == expected);
}
