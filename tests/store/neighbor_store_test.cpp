#include "kinetome/store/neighbor_store.h"

#include <catch2/catch.hpp>

#include "kinetome/base/error.h"
#include "support/temporary_folder.h"

using namespace kinetome;

namespace {

const ArtifactHeader header{.stage = "neighbors"};

NeighborClip clip_named(const std::string& name, const std::string& clip_class, double radius) {
    return {name, clip_class, 480, 120, radius};
}

/// Frame i has the neighbours i, i + step, i + 2 step …
StoredNeighbors every(int32_t step, int32_t frames) {
    StoredNeighbors graph{.offsets = {0}, .neighbours = {}, .distances = {}};
    for (int32_t i = 0; i < frames; ++i) {
        for (int32_t j = i; j < frames; j += step) {
            graph.neighbours.push_back(j);
            graph.distances.push_back(float(j - i) / 2);
        }
        graph.offsets.push_back(int64_t(graph.neighbours.size()));
    }
    return graph;
}

struct Entry {
    NeighborClip clip;
    StoredNeighbors graph;
};

/// Clips of two classes, in the order a shard's features have them.
std::vector<Entry> two_classes() {
    return {{clip_named("a", "20j30d-1", 72), every(1, 5)},
            {clip_named("c", "20j30d-1", 40), every(3, 1)},
            {clip_named("d", "20j30d-1", 72), every(2, 40)},
            {clip_named("b", "31j62d-2", 72), every(4, 9)}};
}

ArtifactRecord write(const std::filesystem::path& path, const std::vector<Entry>& entries) {
    NeighborShardWriter writer(path, header, {}, 30);
    for (const Entry& one : entries) {
        writer.add(one.clip, one.graph.offsets, one.graph.neighbours, one.graph.distances);
    }
    return writer.close();
}

}  // namespace

TEST_CASE("the graph of every clip is read as it was written, whatever lies before it") {
    const TemporaryFolder folder;
    const auto written = two_classes();
    const ArtifactRecord record = write(folder / "neighbors-1.h5", written);
    const NeighborShardReader shard(ArtifactReader(folder / "neighbors-1.h5", record.hash));
    REQUIRE(shard.clips().size() == written.size());
    for (size_t i = 0; i < written.size(); ++i) {
        const auto& [clip, graph] = written[i];
        const NeighborShardClip& found = shard.clips()[i];
        INFO(clip.name);
        CHECK(found.clip.name == clip.name);
        CHECK(found.clip.clip_class == clip.clip_class);
        CHECK(found.clip.source_frames == 480);
        CHECK(found.clip.source_rate == 120);
        CHECK(found.clip.radius == clip.radius);
        CHECK(found.frames == int64_t(graph.offsets.size()) - 1);
        CHECK(found.edges == int64_t(graph.neighbours.size()));
        const StoredNeighbors read = shard.read(i);
        CHECK(read.offsets == graph.offsets);
        CHECK(read.neighbours == graph.neighbours);
        CHECK(read.distances == graph.distances);
    }
    CHECK(shard.effector_rate("31j62d-2") == 30);
    CHECK_THROWS_AS(shard.read(4), std::out_of_range);
}

TEST_CASE("a shard in which no clip has effectors is a file without clips") {
    const TemporaryFolder folder;
    const ArtifactRecord record = write(folder / "neighbors-1.h5", {});
    CHECK(NeighborShardReader(ArtifactReader(folder / "neighbors-1.h5", record.hash))
              .clips()
              .empty());
}

TEST_CASE("counts that do not add up to a clip's edges are refused, naming the clip") {
    const TemporaryFolder folder;
    NeighborShardWriter writer(folder / "neighbors-1.h5", header, {}, 30);
    StoredNeighbors graph = every(1, 4);
    graph.offsets.back() -= 1;
    writer.add(clip_named("odd", "1j1d-1", 1), graph.offsets, graph.neighbours, graph.distances);
    const ArtifactRecord record = writer.close();
    const NeighborShardReader shard(ArtifactReader(folder / "neighbors-1.h5", record.hash));
    CHECK_THROWS_WITH(shard.read(0), Catch::Contains("neighbors-1.h5") && Catch::Contains("odd"));
}
