#include "kinetome/stages/projection.h"

#include "kinetome/base/parallel.h"

namespace kinetome {

MatrixF project_rows(const PosePartition& partition, const Pca& pca, int threads,
                     const StopToken& stop) {
    MatrixF projected(partition.rows(), pca.dimension());
    const auto& pieces = partition.layout.pieces;
    parallel_for(threads, static_cast<int64_t>(pieces.size()), [&](int64_t p) {
        stop.check();
        const RowRange& piece = pieces[static_cast<size_t>(p)];
        projected.middleRows(piece.first, piece.size()) = pca.project(partition.read(piece));
    });
    return projected;
}

}  // namespace kinetome
