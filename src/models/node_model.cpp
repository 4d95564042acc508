#include "node_model.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "kinetome/models/pose_hierarchy.h"

namespace kinetome {
namespace {

constexpr double mm_per_cm = 10;
/// Variances below this share of the largest are rounding: their directions mean nothing.
constexpr double least_variance_share = 1e-12;

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

/// Squared error, cm² per marker, that the largest d of all variances (ascending) leave.
double variance_left(const VectorD& ascending, int64_t dimension) {
    double left = 0;
    for (int64_t i = 0; i + dimension < ascending.size(); ++i) left += std::max(ascending[i], 0.0);
    return left;
}

/// No d variances hold more than √d times the root of the sum of all squared: what is surely left.
double least_variance_left(const MatrixD& covariance, int64_t dimension) {
    return covariance.trace() - std::sqrt(static_cast<double>(dimension)) * covariance.norm();
}

/// An eigenvector's sign is arbitrary: this fixes it.
void make_largest_entry_positive(Eigen::Ref<VectorD> vector) {
    Eigen::Index largest = 0;
    vector.cwiseAbs().maxCoeff(&largest);
    if (vector[largest] < 0) vector *= -1;
}

MatrixD leading_directions(const Solver& solver, int64_t dimension) {
    const VectorD& ascending = solver.eigenvalues();
    const int64_t columns = ascending.size();
    const double least = least_variance_share * ascending[columns - 1];
    MatrixD basis = MatrixD::Zero(columns, dimension);
    for (int64_t k = 0; k < std::min(dimension, columns); ++k) {
        if (!(ascending[columns - 1 - k] > std::max(least, 0.0))) break;
        VectorD direction = solver.eigenvectors().col(columns - 1 - k);
        make_largest_entry_positive(direction);
        basis.col(k) = direction;
    }
    return basis;
}

/// None when all coincide, to the rounding of their float values.
VectorD direction_of_most_spread(const MatrixD& covariance) {
    constexpr double least_deviation = 1e-4;  // cm
    if (covariance.rows() == 0) return {};
    const Solver solver(covariance);
    const double variance = solver.eigenvalues()[covariance.rows() - 1];
    if (!(variance > least_deviation * least_deviation)) return {};
    VectorD direction = solver.eigenvectors().rightCols(1);
    make_largest_entry_positive(direction);
    return direction;
}

}  // namespace

FittedNode fit_node(const Moments& poses, const std::vector<int32_t>& principal_columns,
                    const MarkerMap* parent, const PoseHierarchyOptions& options) {
    const MatrixD covariance = poses.scatter / static_cast<double>(poses.count);
    const auto markers = static_cast<double>(compared_markers(poses.dimension()));
    const double allowed = std::pow(options.leaf_tolerance / mm_per_cm, 2) * markers;

    FittedNode fitted;
    NodeModel& model = fitted.model;
    model.rows = poses.count;
    model.mean = poses.mean;
    model.map = fit_marker_map(poses, principal_columns, parent, options.maps);
    const auto fit_leaf = [&](Solver& solver) {
        solver.compute(covariance);
        model.error =
            mm_per_cm * std::sqrt(variance_left(solver.eigenvalues(), options.dimension) / markers);
        model.basis = leading_directions(solver, options.dimension);
    };
    if (least_variance_left(covariance, options.dimension) <= allowed) {
        Solver solver(covariance, Eigen::EigenvaluesOnly);
        if (variance_left(solver.eigenvalues(), options.dimension) <= allowed) fit_leaf(solver);
    }
    if (!fitted.may_be_leaf() || options.leaf_rule == LeafRule::maximum) {
        fitted.spread_along = direction_of_most_spread(model.map.principal_covariance);
    }
    if (!fitted.may_be_leaf() && !fitted.can_split()) {
        Solver solver;
        fit_leaf(solver);
    }
    return fitted;
}

void pack(Packer& out, const FittedNode& node) {
    pack(out, node.model);
    pack(out, node.spread_along);
}

void unpack(Unpacker& in, FittedNode& node) {
    unpack(in, node.model);
    unpack(in, node.spread_along);
}

}  // namespace kinetome
