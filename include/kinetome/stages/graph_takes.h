// The takes of a corpus as their neighbourhood graphs show them: what stages that cut and compare
// motion (S3) go through, shared by ranks and threads.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/packing.h"
#include "kinetome/models/neighbor_graph.h"
#include "kinetome/stages/stage.h"
#include "kinetome/stages/work_share.h"
#include "kinetome/store/feature_store.h"
#include "kinetome/store/neighbor_store.h"

namespace kinetome {

/// Where a take's features and graph are stored.
struct GraphTakePlace {
    NeighborClip clip;
    int64_t frames = 0;  ///< at the effector rate

    std::shared_ptr<const FeatureShardReader> features;
    int64_t first_effector_row = 0;
    std::shared_ptr<const NeighborShardReader> neighbors;
    size_t number_in_shard = 0;
};

/// One take, read.
struct GraphTake {
    MatrixF features;  ///< frames × d: what the graph was searched in
    NeighborGraph graph;
};

/// All takes that have a graph, by name.
class GraphTakes {
  public:
    /// Opens the features and the graphs among the task's inputs.
    GraphTakes(const StageContext& context, const StageTask& task);

    const std::vector<GraphTakePlace>& places() const { return places_; }
    /// Thread-safe.
    MatrixF features(size_t i) const;
    GraphTake read(size_t i) const;
    /// Memory of the largest one.
    uint64_t largest_bytes() const;

    /// Calls work(i) for every take of this rank's share, several at once.
    void for_share(const std::function<void(size_t)>& work) const;
    /// The rank that a take is shared out to.
    int owner(size_t i) const { return owners_[i]; }

  private:
    const StageContext& context_;
    std::vector<GraphTakePlace> places_;
    std::vector<int> owners_;
};

/// work(i) of every take, made by the ranks together; all at rank 0, none at the others.
template <class Result, class Work>
std::vector<Result> for_takes(const StageContext& context, const GraphTakes& takes, Work&& work) {
    std::vector<Result> results(takes.places().size());
    takes.for_share([&](size_t i) { results[i] = work(i); });
    const Workers workers = context.workers();
    if (workers.rank_count() == 1) return results;
    Packer mine;
    for (size_t i = 0; i < results.size() && !workers.is_root(); ++i) {
        if (takes.owner(i) == workers.rank()) pack(mine, results[i]);
    }
    const std::vector<std::string> brought = workers.ranks->gather(mine.take());
    if (!workers.is_root()) return {};
    for (int rank = 1; rank < workers.rank_count(); ++rank) {
        Unpacker in(brought[static_cast<size_t>(rank)]);
        for (size_t i = 0; i < results.size(); ++i) {
            if (takes.owner(i) == rank) unpack(in, results[i]);
        }
    }
    return results;
}

}  // namespace kinetome
