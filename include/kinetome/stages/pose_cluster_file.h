// pose_clusters.h5: principal components and mixture of each partition.
#pragma once

#include <string>
#include <vector>

#include "kinetome/math/mixture.h"
#include "kinetome/math/pca.h"
#include "kinetome/models/pose_clusters.h"
#include "kinetome/store/artifact.h"

namespace kinetome {

/// What motion strings need of a partition's model.
struct StoredPoseClusters {
    Pca pca;
    Mixture mixture;
};

void write_pose_clusters(ArtifactWriter& file, const std::string& partition, const Pca& pca,
                         const PoseClusters& clusters);
/// Throws StoreError when the file does not hold that partition.
StoredPoseClusters read_pose_clusters(const ArtifactReader& file, const std::string& partition);

}  // namespace kinetome
