#include "kinetome/models/movement_rows.h"

#include <stdexcept>

#include "primitive_rows.h"

namespace kinetome {

MatrixF movement_rows(const MatrixFView& stacked, std::span<const CorpusPrimitive> primitives,
                      const MovementOptions& options) {
    if (stacked.cols() % 3 != 0) {
        throw std::invalid_argument("rows of movements are of three poses each");
    }
    require_rows(stacked, primitives);
    const int64_t columns = stacked.cols(), pose = columns / 3;
    MatrixF rows(stacked.rows(), columns + pose);
    rows.leftCols(columns) = stacked;
    rows.rightCols(pose) =
        (stacked.rightCols(pose) - stacked.leftCols(pose)) * static_cast<float>(options.change);
    for (const CorpusPrimitive& primitive : primitives) {
        auto own = rows.block(primitive.rows.first, 0, primitive.rows.size(), columns);
        const Eigen::RowVectorXd mean = own.cast<double>().colwise().mean();
        own.rowwise() -= ((1 - options.posture) * mean).cast<float>();
    }
    return rows;
}

}  // namespace kinetome
