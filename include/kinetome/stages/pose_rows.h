// The pose vectors that are clustered together: one class of skeletons, the whole corpus or one
// subject, clips in name order across the feature shards, read as they are needed.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"
#include "kinetome/stages/stage.h"
#include "kinetome/store/feature_store.h"

namespace kinetome {

/// One clip of a partition.
struct PartitionClip {
    FeatureShardClip place;
    std::shared_ptr<const FeatureShardReader> shard;
    int64_t first_row = 0;  ///< in the partition
};

/// Rows that share principal components, clusters and letters.
struct PosePartition {
    std::string clip_class;
    std::string path;  ///< HDF5 group: "/<class>/all" or "/<class>/subject-<subject>"
    std::vector<PartitionClip> clips;
    PieceLayout layout;

    int64_t rows() const { return layout.rows(); }
    /// Pose vectors of a run of rows, count × columns. Thread-safe.
    MatrixF read(const RowRange& range) const;
    FeatureClass feature_class() const;
};

/// All partitions, ordered by path. `features` are the finished feature shards in clip order.
std::vector<PosePartition> pose_partitions(const StageContext& context,
                                           const std::vector<const FinishedWork*>& features);

/// What the subjects of the takes add to a key: nothing unless --partition may use them.
Digest subjects_digest(const Survey& survey, const PartitionOptions& options);

}  // namespace kinetome
