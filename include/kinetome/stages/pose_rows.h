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

/// Rows that share a model: principal components, clusters and letters, or a pose hierarchy.
struct PosePartition {
    std::string clip_class;
    std::string path;  ///< HDF5 group: "/<class>/all" or "/<class>/subject-<subject>"; of a whole
                       ///< class: "/<class>"
    std::vector<PartitionClip> clips;
    PieceLayout layout;

    int64_t rows() const { return layout.rows(); }
    /// Pose vectors of a run of rows, count × columns. Thread-safe.
    MatrixF read(const RowRange& range) const;
    /// Normalised markers of a run of rows, count × 3·joints, cm. Thread-safe.
    MatrixF read_markers(const RowRange& range) const;
    FeatureClass feature_class() const;
};

/// All partitions, ordered by path. `features` are the finished feature shards in clip order.
std::vector<PosePartition> pose_partitions(const StageContext& context,
                                           const std::vector<const FinishedWork*>& features);

/// One partition a class, ordered by class.
std::vector<PosePartition> class_partitions(const StageContext& context,
                                            const std::vector<const FinishedWork*>& features);

/// What the subjects of the takes add to a key: nothing unless --partition may use them.
Digest subjects_digest(const Survey& survey, const PartitionOptions& options);

}  // namespace kinetome
