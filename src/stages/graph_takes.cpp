#include "kinetome/stages/graph_takes.h"

#include <algorithm>
#include <map>

#include "clip_pipeline.h"
#include "kinetome/stages/corpus_shape.h"
#include "kinetome/stages/graph_features.h"

namespace kinetome {
namespace {

/// Adds the takes of one shard.
void append_places(const StageContext& context, const FinishedWork& features,
                   const FinishedWork& neighbors, std::vector<GraphTakePlace>& places) {
    const auto rows = std::make_shared<const FeatureShardReader>(context.workspace.open(features));
    const auto graphs =
        std::make_shared<const NeighborShardReader>(context.workspace.open(neighbors));
    std::map<std::string, int64_t> first_row;
    for (const FeatureShardClip& clip : rows->clips()) {
        first_row[clip.name] = clip.first_effector_row;
    }
    for (size_t i = 0; i < graphs->clips().size(); ++i) {
        const NeighborShardClip& graph = graphs->clips()[i];
        places.push_back(
            {graph.clip, graph.frames, rows, first_row.at(graph.clip.name), graphs, i});
    }
}

}  // namespace

GraphTakes::GraphTakes(const StageContext& context, const StageTask& task) : context_(context) {
    const auto features = task.inputs_of("features"), neighbors = task.inputs_of("neighbors");
    for (size_t shard = 0; shard < neighbors.size(); ++shard) {
        append_places(context, *features.at(shard), *neighbors[shard], places_);
    }
    std::sort(places_.begin(), places_.end(),
              [](const auto& a, const auto& b) { return a.clip.name < b.clip.name; });
    std::vector<int64_t> frames;
    for (const GraphTakePlace& place : places_) frames.push_back(place.frames);
    owners_ = share_out(frames, context.workers().rank_count(), false);
}

MatrixF GraphTakes::features(size_t i) const {
    const GraphTakePlace& place = places_[i];
    return graph_features(
        place.features->effectors(place.clip.clip_class, place.first_effector_row, place.frames),
        context_.options);
}

GraphTake GraphTakes::read(size_t i) const {
    StoredNeighbors stored = places_[i].neighbors->read(places_[i].number_in_shard);
    return {features(i), NeighborGraph(std::move(stored.offsets), std::move(stored.neighbours),
                                       std::move(stored.distances))};
}

uint64_t GraphTakes::largest_bytes() const {
    int64_t largest = 0;
    for (const GraphTakePlace& place : places_) largest = std::max(largest, place.frames);
    // Read, symmetrised and weighted: as much as building it.
    return neighbor_graph_bytes(largest, 3 * effector_values, context_.options.neighbors.knn);
}

void GraphTakes::for_share(const std::function<void(size_t)>& work) const {
    const size_t in_flight = clips_in_flight(context_.resources, largest_bytes());
    std::vector<size_t> share;
    for (size_t i = 0; i < places_.size(); ++i) {
        if (owners_[i] == context_.workers().rank()) share.push_back(i);
    }
    // Other ranks are asked only between batches: inside, any thread may be at work.
    constexpr size_t batch = 64;
    for (size_t first = 0; first < share.size(); first += batch) {
        context_.check_ranks();
        size_t next = first;
        const size_t end = std::min(first + batch, share.size());
        const auto read = [&]() -> std::shared_ptr<const size_t> {
            return next < end ? std::make_shared<const size_t>(share[next++]) : nullptr;
        };
        run_clip_pipeline<const size_t>(
            in_flight, context_.stop, read, [&](size_t i) { work(i); }, [](size_t) {});
    }
}

}  // namespace kinetome
