// The rows that the graph of all takes is searched among: one class of skeletons, clips in name
// order across the feature shards, read as they are needed.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"
#include "kinetome/stages/stage.h"
#include "kinetome/store/feature_store.h"

namespace kinetome {

/// One clip that has effectors.
struct GraphClip {
    FeatureShardClip place;
    std::shared_ptr<const FeatureShardReader> shard;
    std::string cut;  ///< of its shard
};

/// Rows are frames at the effector rate.
class GraphRows {
  public:
    GraphRows(std::vector<GraphClip> clips, const ReindexOptions& options);

    const std::vector<GraphClip>& clips() const { return clips_; }
    /// Clip c holds rows [offsets()[c], offsets()[c + 1]).
    const std::vector<int64_t>& offsets() const { return offsets_; }
    int64_t rows() const { return offsets_.back(); }
    /// The clip that a row is of.
    size_t clip_of(int64_t row) const;
    /// What is compared of a run of rows (graph_features). Thread-safe.
    MatrixF features(const RowRange& range) const;

  private:
    std::vector<GraphClip> clips_;
    std::vector<int64_t> offsets_;
    const ReindexOptions& options_;
};

/// By class. `features` are the finished shards in clip order.
std::map<std::string, GraphRows> graph_rows(const StageContext& context,
                                            const std::vector<const FinishedWork*>& features);

/// How many rows are asked for, and how many are searched, at a time: as many as an eighth of the
/// memory holds.
struct GraphSearchSize {
    GraphSearchSize(const ReindexOptions& options, const Resources& resources);

    uint64_t bytes_per_query = 0;  ///< its features and its list
    uint64_t bytes_per_row = 0;    ///< its features and their index
    int64_t queries = 0;
    int64_t rows = 0;
};

}  // namespace kinetome
