#include "kinetome/stages/projected_rows.h"

namespace kinetome {

KeptRows projected_rows(const PosePartition& partition, const Pca& pca, const Workers& workers,
                        uint64_t kept_bytes, StopToken stop) {
    const auto project = [&partition, &pca, stop](const RowRange& range) {
        stop.check();
        return pca.project(partition.read(range));
    };
    return {partition.layout, pca.dimension(), project, workers, kept_bytes};
}

}  // namespace kinetome
