#include "node_model.h"

#include <algorithm>
#include <cmath>

#include "kinetome/math/symmetric_eigen.h"
#include "kinetome/models/pose_hierarchy.h"

namespace kinetome {
namespace {

constexpr double mm_per_cm = 10;
/// Variances below this share of the largest are rounding: their directions mean nothing.
constexpr double least_variance_share = 1e-12;

/// Squared error, cm² per marker, that the largest d of all variances leave. The least are added
/// first: rounding takes nothing from them.
double variance_left(const VectorD& variances, int64_t dimension) {
    double left = 0;
    for (int64_t i = variances.size(); i-- > dimension;) left += std::max(variances[i], 0.0);
    return left;
}

/// No d variances hold more than √d times the root of the sum of all squared: what is surely left.
double least_variance_left(const MatrixD& covariance, int64_t dimension) {
    return covariance.trace() - std::sqrt(static_cast<double>(dimension)) * covariance.norm();
}

MatrixD leading_directions(const SymmetricEigen& eigen, int64_t dimension) {
    const int64_t columns = eigen.values.size();
    const double least = std::max(least_variance_share * eigen.values[0], 0.0);
    MatrixD basis = MatrixD::Zero(columns, dimension);
    for (int64_t k = 0; k < std::min(dimension, columns) && eigen.values[k] > least; ++k) {
        VectorD direction = eigen.vectors.col(k);
        make_largest_entry_positive(direction);
        basis.col(k) = direction;
    }
    return basis;
}

/// None when all coincide, to the rounding of their float values.
VectorD direction_of_most_spread(const MatrixD& covariance) {
    constexpr double least_deviation = 1e-4;  // cm
    if (covariance.rows() == 0) return {};
    const SymmetricEigen eigen = symmetric_eigen(covariance);
    if (!(eigen.values[0] > least_deviation * least_deviation)) return {};
    VectorD direction = eigen.vectors.col(0);
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
    const auto fit_leaf = [&] {
        const SymmetricEigen eigen = symmetric_eigen(covariance);
        model.error =
            mm_per_cm * std::sqrt(variance_left(eigen.values, options.dimension) / markers);
        model.basis = leading_directions(eigen, options.dimension);
    };
    if (least_variance_left(covariance, options.dimension) <= allowed &&
        variance_left(symmetric_eigenvalues(covariance), options.dimension) <= allowed) {
        fit_leaf();
    }
    if (!fitted.may_be_leaf() || options.leaf_rule == LeafRule::maximum) {
        fitted.spread_along = direction_of_most_spread(model.map.principal_covariance);
    }
    if (!fitted.may_be_leaf() && !fitted.can_split()) fit_leaf();
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
