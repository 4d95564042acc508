#include "kinetome/models/placed_signature.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "kinetome/math/symmetric_eigen.h"

namespace kinetome {
namespace {

constexpr double mm_per_cm = 10;

/// Of leaves, as many times as they have poses.
VectorD leaf_weights(const PoseHierarchy& hierarchy) {
    VectorD weights = VectorD::Zero(hierarchy.leaves());
    for (const HierarchyNode& node : hierarchy.nodes) {
        if (node.is_leaf()) weights[node.leaf] = static_cast<double>(node.rows);
    }
    return weights / weights.sum();
}

/// How poses vary, as the hierarchy tells: from leaf to leaf, and along the components of each. How
/// far they go along those is not kept; the tolerance is what a leaf would not leave them out for.
MatrixD covariance_of(const PoseHierarchy& hierarchy) {
    const VectorD weights = leaf_weights(hierarchy);
    const VectorD middle = hierarchy.means.transpose() * weights;
    const MatrixD means = hierarchy.means.rowwise() - middle.transpose();
    MatrixD covariance = means.transpose() * weights.asDiagonal() * means;
    const double spread = hierarchy.tolerance / mm_per_cm;
    for (int32_t leaf = 0; leaf < hierarchy.leaves(); ++leaf) {
        const MatrixD basis = spread * std::sqrt(weights[leaf]) * hierarchy.basis(leaf);
        covariance.selfadjointView<Eigen::Lower>().rankUpdate(basis);
    }
    return covariance;
}

}  // namespace

int64_t signature_axis_count(int64_t columns) {
    constexpr int64_t most = 24;
    return std::min(most, columns);
}

MatrixF signature_axes(const PoseHierarchy& hierarchy) {
    const double scale =
        mm_per_cm / std::sqrt(static_cast<double>(compared_markers(hierarchy.columns())));
    const SymmetricEigen eigen = symmetric_eigen(covariance_of(hierarchy));
    return (scale * eigen.vectors.leftCols(signature_axis_count(hierarchy.columns())))
        .cast<float>();
}

MatrixF positions_of(const MatrixDView& poses, const MatrixF& axes) {
    return (poses * axes.cast<double>()).cast<float>();
}

PlacedSignature place_signature(Signature signature, const MatrixFView& poses,
                                const MatrixF& axes) {
    if (poses.rows() != frame_count(signature)) {
        throw std::invalid_argument(fmt::format("{} poses were given for a signature of {} frames",
                                                poses.rows(), frame_count(signature)));
    }
    MatrixD means(static_cast<Eigen::Index>(signature.size()), poses.cols());
    for (Eigen::Index i = 0; i < means.rows(); ++i) {
        const SignatureRun& run = signature[static_cast<size_t>(i)];
        const auto of_run = poses.middleRows(run.first_frame, run.frames).cast<double>();
        means.row(i) = of_run.colwise().mean();
    }
    return {std::move(signature), positions_of(means, axes)};
}

}  // namespace kinetome
