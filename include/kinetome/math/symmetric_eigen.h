// Eigenvalues and eigenvectors of a symmetric matrix, such as a covariance.
#pragma once

#include "kinetome/base/matrix.h"

namespace kinetome {

struct SymmetricEigen {
    VectorD values;           ///< n, largest first; rounding may leave a zero slightly negative
    Eigen::MatrixXd vectors;  ///< n × n, one a column, of length 1, of either sign
};

/// Of an n × n matrix, n ≥ 1, of which the lower triangle is read. Throws std::invalid_argument
/// when there are none to be found, as with values that are not finite.
SymmetricEigen symmetric_eigen(const MatrixD& matrix);

/// The same values alone, which are found sooner.
VectorD symmetric_eigenvalues(const MatrixD& matrix);

/// An eigenvector's sign is arbitrary: this fixes it. Of equally large entries the first counts.
void make_largest_entry_positive(Eigen::Ref<VectorD> vector);

}  // namespace kinetome
