// The stage `neighbors`: from feature shards to the graphs of their takes.
#include <catch2/catch.hpp>
#include <cmath>

#include "kinetome/features/effectors.h"
#include "kinetome/models/neighbor_graph.h"
#include "kinetome/stages/stage.h"
#include "kinetome/store/feature_store.h"
#include "kinetome/store/neighbor_store.h"
#include "support/temporary_folder.h"

using namespace kinetome;

namespace {

constexpr int64_t columns = 15;

/// A point that goes round `loops` times, with a body part of its own in every column.
MatrixF loops(int64_t frames, int64_t count) {
    MatrixF rows(frames, columns);
    for (int64_t i = 0; i < frames; ++i) {
        for (int64_t j = 0; j < columns; ++j) {
            const double turn = 6.283185307179586 * double(i * count) / double(frames);
            rows(i, j) = float(30 * std::sin(turn + double(j)));
        }
    }
    return rows;
}

struct Given {
    std::string name;
    MatrixF effectors;
};

/// Makes the graphs of one shard of given effectors.
class OneShard {
  public:
    explicit OneShard(const std::vector<Given>& clips) {
        Receipt receipt;
        receipt.stage = "features";
        receipt.shard = shard_.cut;
        receipt.file = write(clips);
        features_ = workspace_.commit(receipt);
    }

    ReindexOptions options;

    StageResult make(int threads = 2) {
        Resources resources;
        resources.threads = threads;
        resources.memory_bytes = uint64_t{1} << 28;
        const StageContext context{survey_,    shards_, options, resources,
                                   workspace_, log_,    {},      nullptr};
        StageTask task;
        task.output = workspace_.folder() / "neighbors-last.h5";
        task.header = {.stage = "neighbors"};
        task.shard = &shard_;
        task.inputs = {features_};
        return make_neighbors(context, task);
    }
    NeighborShardReader read(const StageResult& result) const {
        return NeighborShardReader(
            ArtifactReader(workspace_.folder() / result.file.file_name, result.file.hash));
    }

  private:
    ArtifactRecord write(const std::vector<Given>& clips) const {
        FeatureShardWriter writer(workspace_.folder() / "features-last.h5", {.stage = "features"},
                                  {});
        FeatureClass shared;
        shared.pose_vector_names = {"a"};
        shared.pose_vector_units = {"rad"};
        shared.pose_vector_floors = {1};
        shared.marker_names = {"m"};
        shared.pose_rate = 120;
        shared.effector_rate = 30;
        writer.begin_class("1j1d-1", shared);
        for (const auto& [name, effectors] : clips) {
            const int64_t frames = std::max<int64_t>(1, effectors.rows());
            writer.add({.name = name,
                        .clip_class = "1j1d-1",
                        .source_frames = frames,
                        .source_rate = 30,
                        .pose_vectors = MatrixF::Zero(frames, 1),
                        .markers = MatrixF::Zero(frames, 3),
                        .effectors = effectors});
        }
        return writer.close();
    }

    TemporaryFolder folder_;
    VerifiedFiles verified_;
    Workspace workspace_{StoreDirectory::open_or_create(folder_ / "store"), nullptr, verified_};
    Log log_;
    Survey survey_;
    Shard shard_{.cut = "last", .clips = {}};
    std::vector<Shard> shards_;
    FinishedWork features_;
};

}  // namespace

TEST_CASE("the stored graph of a take is that of its stacked effectors") {
    OneShard shard({{"a", loops(200, 4)}, {"b", loops(90, 1)}, {"c", loops(40, 3)}});
    shard.options.neighbors.knn = {25, 30};
    const StageResult result = shard.make();
    CHECK(result.clips.empty());
    const NeighborShardReader stored = shard.read(result);
    REQUIRE(stored.clips().size() == 3);
    const MatrixF features[] = {loops(200, 4), loops(90, 1), loops(40, 3)};
    for (size_t i = 0; i < 3; ++i) {
        const NeighborGraph graph =
            neighbor_graph(stack_neighbours(features[i], 1), {25, 30}, KnnEngine::blocks, 1);
        const StoredNeighbors read = stored.read(i);
        CHECK(read.offsets == graph.offsets());
        CHECK(read.neighbours == graph.all_neighbours());
        CHECK(read.distances == graph.all_distances());
        CHECK(stored.clips()[i].clip.radius == 25);
    }
    CHECK(shard.make(1).file.datasets == result.file.datasets);
}

TEST_CASE("frames are stacked so many seconds apart, in frames of the effector rate") {
    OneShard shard({{"a", loops(200, 4)}});
    shard.options.neighbors.knn = {60, 200};
    shard.options.neighbors.stack_offset = 0.1;
    const StageResult result = shard.make();
    const NeighborGraph graph =
        neighbor_graph(stack_neighbours(loops(200, 4), 3), {60, 200}, KnnEngine::blocks, 1);
    CHECK(shard.read(result).read(0).distances == graph.all_distances());
}

TEST_CASE("of some joints alone, the graph is that of their columns within a smaller radius") {
    OneShard shard({{"a", loops(200, 4)}});
    shard.options.neighbors.joints = {JointRole::left_wrist, JointRole::right_wrist};
    const NeighborShardReader stored = shard.read(shard.make());
    const double radius = 72 * std::sqrt(2.0 / 5);
    CHECK(stored.clips()[0].clip.radius == Approx(radius));
    const NeighborGraph graph =
        neighbor_graph(stack_neighbours(loops(200, 4).middleCols(3, 6), 1),
                       {stored.clips()[0].clip.radius, 128}, KnnEngine::blocks, 1);
    CHECK(stored.read(0).neighbours == graph.all_neighbours());
}

TEST_CASE("an adapted radius is each take's own") {
    OneShard shard({{"large", loops(200, 4) * 10}, {"small", loops(200, 4) / 4}});
    shard.options.neighbors.adapt_radius = 0.5;
    const NeighborShardReader stored = shard.read(shard.make());
    CHECK(stored.clips()[0].clip.radius == 72);
    const double small = stored.clips()[1].clip.radius;
    CHECK(small > 10);
    CHECK(small < 40);
    for (const float distance : stored.read(1).distances) CHECK(double(distance) <= small);
}

TEST_CASE("takes that are short, still or repeated to the bit have their graphs") {
    const MatrixF one = loops(1, 1), few = loops(13, 1), still = MatrixF::Constant(300, columns, 7);
    MatrixF twice(120, columns);
    twice << loops(60, 2), loops(60, 2);
    OneShard shard({{"few", few}, {"one", one}, {"still", still}, {"twice", twice}});
    shard.options.neighbors.stack_offset = 0;
    const NeighborShardReader stored = shard.read(shard.make());
    const auto graph_of = [&](size_t i) {
        StoredNeighbors read = stored.read(i);
        return NeighborGraph(read.offsets, read.neighbours, read.distances);
    };
    const NeighborGraph of_few = graph_of(0), of_one = graph_of(1), of_still = graph_of(2),
                        of_twice = graph_of(3);
    CHECK(of_few.frames() == 13);
    REQUIRE(of_one.frames() == 1);
    CHECK(of_one.has_edge(0, 0));
    for (int64_t i = 0; i < 300; ++i) {  // of frames that are all alike, the first are listed
        REQUIRE(of_still.neighbours(i).size() == 128);
        CHECK(of_still.neighbours(i).back() == 127);
    }
    for (int64_t i = 0; i < 60; ++i) {
        CHECK(of_twice.has_edge(i, i + 60));
        CHECK(of_twice.has_edge(i + 60, i));
    }
}

TEST_CASE("a clip without effectors is left out, and why is told") {
    OneShard shard({{"a", loops(50, 1)}, {"b", MatrixF()}, {"c", loops(20, 1)}});
    const StageResult result = shard.make();
    REQUIRE(result.clips.size() == 1);
    CHECK(result.clips[0].clip == "b");
    CHECK_THAT(result.clips[0].skipped, Catch::Contains("head, wrists or ankles"));
    const NeighborShardReader stored = shard.read(result);
    REQUIRE(stored.clips().size() == 2);
    CHECK(stored.clips()[1].clip.name == "c");
    CHECK(stored.read(1).offsets.size() == 21);
}

TEST_CASE("without any clip with effectors there is a file without clips") {
    OneShard shard({{"a", MatrixF()}});
    const StageResult result = shard.make();
    CHECK(result.clips.size() == 1);
    CHECK(shard.read(result).clips().empty());
}
