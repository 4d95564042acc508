// The stage `corpus_neighbors`: neighbours among the frames of all takes.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "kinetome/base/error.h"
#include "kinetome/math/knn.h"
#include "kinetome/stages/graph_features.h"
#include "kinetome/stages/open_store.h"
#include "kinetome/stages/reindex.h"
#include "kinetome/stages/verification.h"
#include "kinetome/store/feature_store.h"
#include "kinetome/store/neighbor_store.h"
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
    request.only = {"frames", "features", "neighbors", "corpus_neighbors"};
    request.options.frames.shard_frames = group_frames;
    request.options.neighbors.knn = {60, 40};
    request.options.corpus_neighbors.wanted = true;
    request.resources.threads = 2;
    request.resources.memory_bytes = uint64_t{1} << 30;
    return request;
}

fs::path generated(const TemporaryFolder& folder, int64_t frames) {
    generate_corpus({.frames = frames, .seed = 3, .subjects = 3}, folder / "takes", 2);
    return folder / "takes";
}

struct Edge {
    std::string clip;
    int32_t frame = 0;
    float distance = 0;
    bool operator==(const Edge&) const = default;
};

struct ClipGraph {
    std::string name;
    std::vector<std::vector<Edge>> frames;
};

/// Graphs of all shards of a stage, clips in name order.
std::vector<ClipGraph> graphs_of(const fs::path& store, const std::string& stage) {
    const OpenStore open(store);
    std::map<int64_t, std::string> names;
    for (const CatalogClip& clip : open.generation.catalog().clips) names[clip.id] = clip.name;
    std::vector<ClipGraph> graphs;
    for (const Receipt* receipt : open.generation.ledger().of_stage(stage)) {
        const NeighborShardReader shard(open.generation.open(receipt->file.file_name));
        for (size_t i = 0; i < shard.clips().size(); ++i) {
            const StoredNeighbors read = shard.read(i);
            ClipGraph graph{shard.clips()[i].clip.name, {}};
            for (size_t f = 1; f < read.offsets.size(); ++f) {
                auto& edges = graph.frames.emplace_back();
                for (auto e = size_t(read.offsets[f - 1]); e < size_t(read.offsets[f]); ++e) {
                    const std::string& clip =
                        read.clips.empty() ? graph.name : names.at(read.clips[e]);
                    edges.push_back({clip, read.neighbours[e], read.distances[e]});
                }
            }
            graphs.push_back(std::move(graph));
        }
    }
    return graphs;
}

/// The same, by one search among all rows in memory.
std::vector<ClipGraph> searched_at_once(const fs::path& store, const ReindexOptions& options) {
    const OpenStore open(store);
    std::vector<std::string> names;
    std::vector<MatrixF> features;
    std::vector<int64_t> offsets = {0};
    for (const Receipt* receipt : open.generation.ledger().of_stage("features")) {
        const FeatureShardReader shard(open.generation.open(receipt->file.file_name));
        for (const FeatureShardClip& clip : shard.clips()) {
            names.push_back(clip.name);
            features.push_back(graph_features(
                shard.effectors(clip.clip_class, clip.first_effector_row, clip.effector_rows),
                options));
            offsets.push_back(offsets.back() + clip.effector_rows);
        }
    }
    MatrixF rows(offsets.back(), features.front().cols());
    for (size_t c = 0; c < names.size(); ++c) {
        rows.middleRows(offsets[c], features[c].rows()) = features[c];
    }
    const auto apart = std::llround(options.corpus_neighbors.exclusion * 30);
    const NeighbourLists lists = KnnIndex(rows, KnnEngine::blocks, 2)
                                     .search(rows, options.neighbors.knn, 2,
                                             rows_nearby_in_time(offsets, {0, rows.rows()}, apart));
    std::vector<ClipGraph> graphs;
    for (size_t c = 0; c < names.size(); ++c) {
        ClipGraph graph{names[c], {}};
        for (int64_t row = offsets[c]; row < offsets[c + 1]; ++row) {
            std::vector<std::pair<int32_t, float>> found;
            for (size_t e = 0; e < lists.rows_of(row).size(); ++e) {
                found.emplace_back(lists.rows_of(row)[e], lists.distances_of(row)[e]);
            }
            std::sort(found.begin(), found.end());
            auto& edges = graph.frames.emplace_back();
            for (const auto& [neighbour, distance] : found) {
                const auto clip =
                    size_t(std::upper_bound(offsets.begin(), offsets.end(), neighbour) -
                           offsets.begin() - 1);
                edges.push_back({names[clip], int32_t(neighbour - offsets[clip]), distance});
            }
        }
        graphs.push_back(std::move(graph));
    }
    return graphs;
}

std::string digests_of(const fs::path& store) {
    const OpenStore open(store);
    std::string text;
    for (const LogicalDigest& one : logical_digests(open.generation)) {
        text += fmt::format("{}/{} {}\n", one.artifact, one.dataset, one.digest.hex());
    }
    return text;
}

}  // namespace

TEST_CASE("shard by shard and part by part, the neighbours are those among all frames at once") {
    const TemporaryFolder folder;
    ReindexRequest request = request_for(generated(folder, 24'000), folder / "store");
    request.resources.memory_bytes = 1;  // parts of 1024 frames
    request.options.corpus_neighbors.exclusion = GENERATE(0.0, 0.5);
    const RunSummary summary = reindex(request, Log(), {});
    REQUIRE(summary.stages.back().name == "corpus_neighbors");
    REQUIRE(summary.stages.back().made > 2);
    const auto expected = searched_at_once(request.store, request.options);
    const auto stored = graphs_of(request.store, "corpus_neighbors");
    REQUIRE(stored.size() == expected.size());
    int64_t edges = 0, of_other_clips = 0;
    for (size_t c = 0; c < stored.size(); ++c) {
        INFO(stored[c].name);
        CHECK(stored[c].name == expected[c].name);
        CHECK(stored[c].frames == expected[c].frames);
        for (size_t f = 0; f < stored[c].frames.size(); ++f) {
            for (const Edge& edge : stored[c].frames[f]) {
                ++edges;
                of_other_clips += edge.clip != stored[c].name;
                const bool near =
                    edge.clip == stored[c].name && std::abs(edge.frame - int64_t(f)) < 15;
                if (request.options.corpus_neighbors.exclusion > 0) CHECK_FALSE(near);
            }
        }
    }
    CHECK(of_other_clips > edges / 20);
    CHECK(of_other_clips < edges);
}

TEST_CASE("the graph of all takes does not depend on shards, threads, ranks or memory") {
    const TemporaryFolder folder;
    const fs::path corpus = generated(folder, 24'000);
    ReindexRequest request = request_for(corpus, folder / "first");
    request.options.neighbors.adapt_radius = 0.5;  // each take has a radius of its own
    reindex(request, Log(), {});
    const std::string expected = digests_of(request.store);
    REQUIRE_THAT(expected, Catch::Contains("corpus_neighbors/"));

    request.store = folder / "one shard";
    request.options.frames.shard_frames = 65'536;
    request.resources.threads = 1;
    CHECK(reindex(request, Log(), {}).stages.back().made == 1);
    CHECK(digests_of(request.store) == expected);

    request.store = folder / "little memory";
    request.options.frames.shard_frames = group_frames;
    request.resources = {
        .threads = 3, .memory_bytes = 1, .threads_source = "", .memory_source = ""};
    reindex(request, Log(), {});
    CHECK(digests_of(request.store) == expected);

    request.store = folder / "ranks";
    run_as_ranks(3, [&](Communicator& ranks) {
        ReindexRequest mine = request;
        mine.ranks = &ranks;
        reindex(mine, Log(), {});
    });
    CHECK(digests_of(request.store) == expected);
}

TEST_CASE("the graph of all takes is made anew in every shard when a take goes") {
    const TemporaryFolder folder;
    const fs::path corpus = generated(folder, 24'000);
    const ReindexRequest request = request_for(corpus, folder / "store");
    const RunSummary first = reindex(request, Log(), {});
    fs::remove(corpus / "02" / "02_01.amc");
    const RunSummary second = reindex(request, Log(), {});
    for (size_t i = 0; i < first.stages.size(); ++i) {
        INFO(second.stages[i].name);
        const bool of_all = second.stages[i].name == "corpus_neighbors";
        if (of_all) CHECK(second.stages[i].reused == 0);
        if (second.stages[i].name == "neighbors") CHECK(second.stages[i].reused > 0);
    }
    ReindexRequest fresh = request;
    fresh.store = folder / "fresh";
    reindex(fresh, Log(), {});
    CHECK(digests_of(fresh.store) == digests_of(request.store));
}

TEST_CASE("the graph of all takes is made when it is asked for, exactly or not at all") {
    const TemporaryFolder folder;
    ReindexRequest request = request_for(generated(folder, 3'000), folder / "store");
    request.options.corpus_neighbors.wanted = false;
    CHECK_THROWS_WITH(reindex(request, Log(), {}), Catch::Contains("--corpus-graph on"));
    request.only.erase("corpus_neighbors");
    const RunSummary summary = reindex(request, Log(), {});
    CHECK(summary.stages.back().name != "corpus_neighbors");
    CHECK(OpenStore(request.store).generation.ledger().of_stage("corpus_neighbors").empty());
    request.options.corpus_neighbors.wanted = true;
    request.options.neighbors.engine = KnnEngine::flann;
    CHECK_THROWS_WITH(check_options(request.options), Catch::Contains("knn-engine blocks"));
}
