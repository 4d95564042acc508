#include "kinetome/math/symmetric_eigen.h"

#include <Eigen/Eigenvalues>
#include <stdexcept>
#include <string>

namespace kinetome {
namespace {

// Instantiating the solver takes a compiler longer than all else in the files that ask for it.
Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(const MatrixD& matrix, int wanted) {
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, wanted);
    if (solver.info() != Eigen::Success) {
        throw std::invalid_argument("the eigenvalues of a symmetric matrix of " +
                                    std::to_string(matrix.rows()) +
                                    " rows were not found: it may hold values that are not finite");
    }
    return solver;
}

}  // namespace

SymmetricEigen symmetric_eigen(const MatrixD& matrix) {
    const auto solver = solved(matrix, Eigen::ComputeEigenvectors);
    return {solver.eigenvalues().reverse(), solver.eigenvectors().rowwise().reverse()};
}

VectorD symmetric_eigenvalues(const MatrixD& matrix) {
    return solved(matrix, Eigen::EigenvaluesOnly).eigenvalues().reverse();
}

void make_largest_entry_positive(Eigen::Ref<VectorD> vector) {
    Eigen::Index largest = 0;
    vector.cwiseAbs().maxCoeff(&largest);
    if (vector[largest] < 0) vector *= -1;
}

}  // namespace kinetome
