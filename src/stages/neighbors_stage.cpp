// neighbors: the neighbourhood graph of each take, shard by shard (S3 §3).
#include <algorithm>
#include <memory>

#include "clip_pipeline.h"
#include "kinetome/base/progress.h"
#include "kinetome/models/neighbor_graph.h"
#include "kinetome/stages/corpus_shape.h"
#include "kinetome/stages/graph_features.h"
#include "kinetome/stages/stage.h"
#include "kinetome/store/feature_store.h"
#include "kinetome/store/neighbor_store.h"

namespace kinetome {
namespace {

struct Passenger {
    FeatureShardClip place;
    MatrixF effectors;
    double radius = 0;
    NeighborGraph graph;
};

void compute(const ReindexOptions& options, Passenger& passenger) {
    const NeighborOptions& asked = options.neighbors;
    const MatrixF features = graph_features(passenger.effectors, options);
    passenger.radius = graph_radius(features, asked);
    // Takes are what runs in parallel here.
    passenger.graph =
        neighbor_graph(features, {passenger.radius, asked.knn.neighbours}, asked.engine, 1);
}

/// Memory that the largest clip of a shard needs on its way.
uint64_t largest_clip(const FeatureShardReader& features, const KnnOptions& options) {
    int64_t largest = 0;
    for (const FeatureShardClip& clip : features.clips()) {
        largest = std::max(largest, clip.effector_rows);
    }
    return neighbor_graph_bytes(largest, 3 * effector_values, options);
}

}  // namespace

StageResult make_neighbors(const StageContext& context, const StageTask& task) {
    const FeatureShardReader features(context.workspace.open(*task.inputs_of("features").front()));
    const ReindexOptions& options = context.options;
    NeighborShardWriter writer(task.output, task.header, context.writing(),
                               options.features.effector_rate);
    int64_t total = 0;
    for (const FeatureShardClip& clip : features.clips()) total += clip.effector_rows;
    Progress progress(context.log, "neighbors " + task.shard->cut, total, "frames");
    StageResult result;

    auto next = features.clips().begin();
    const auto read = [&]() -> std::shared_ptr<Passenger> {
        for (; next != features.clips().end(); ++next) {
            if (next->effector_rows > 0) break;
            result.clips.push_back(
                {.clip = next->name, .skipped = "its skeleton lacks head, wrists or ankles"});
        }
        if (next == features.clips().end()) return nullptr;
        const FeatureShardClip& clip = *next++;
        return std::make_shared<Passenger>(Passenger{
            clip,
            features.effectors(clip.clip_class, clip.first_effector_row, clip.effector_rows),
            0,
            {}});
    };
    const auto work = [&](Passenger& passenger) { compute(options, passenger); };
    const auto write = [&](const Passenger& passenger) {
        const FeatureShardClip& clip = passenger.place;
        const NeighborGraph& graph = passenger.graph;
        writer.add(
            {clip.name, clip.clip_class, clip.source_frames, clip.source_rate, passenger.radius},
            graph.offsets(), graph.all_neighbours(), graph.all_distances());
        progress.advance(graph.frames());
    };
    run_clip_pipeline<Passenger>(
        clips_in_flight(context.resources, largest_clip(features, options.neighbors.knn)),
        context.stop, read, work, write);
    std::sort(result.clips.begin(), result.clips.end(),
              [](const ClipOutcome& a, const ClipOutcome& b) { return a.clip < b.clip; });
    result.file = writer.close();
    return result;
}

}  // namespace kinetome
