// The matrices everything is computed on: rows are frames (or clusters), row-major as on disk.
#pragma once

#include <Eigen/Core>

namespace kinetome {

template <class Scalar>
using RowMatrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

using MatrixF = RowMatrix<float>;
using MatrixD = RowMatrix<double>;
using VectorF = Eigen::VectorXf;
using VectorD = Eigen::VectorXd;

/// Read-only views that bind to a matrix, a map of a buffer or a run of rows, without a copy.
using MatrixFView = Eigen::Ref<const MatrixF>;
using MatrixDView = Eigen::Ref<const MatrixD>;

}  // namespace kinetome
