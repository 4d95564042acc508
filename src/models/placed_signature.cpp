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

/// Of every run. Throws std::invalid_argument for a pose that is not finite.
MatrixD means_of(const Signature& runs, const MatrixFView& poses) {
    MatrixD means(static_cast<Eigen::Index>(runs.size()), poses.cols());
    for (Eigen::Index i = 0; i < means.rows(); ++i) {
        const SignatureRun& run = runs[static_cast<size_t>(i)];
        means.row(i) =
            poses.middleRows(run.first_frame, run.frames).cast<double>().colwise().mean();
        if (means.row(i).allFinite()) continue;
        throw std::invalid_argument(fmt::format("a pose among frames {}:{} is not finite",
                                                run.first_frame, run.end_frame()));
    }
    return means;
}

MatrixD poses_at(const FrameSamples& samples, const MatrixFView& poses) {
    MatrixD sampled(samples.count(), poses.cols());
    for (Eigen::Index i = 0; i < sampled.rows(); ++i) {
        sampled.row(i) = poses.row(samples.frame(i)).cast<double>();
    }
    return sampled;
}

/// At a frame of the motion, by the cubic Hermite spline through samples; its tangent at a sample
/// is the slope between those beside it.
void put_position(const MatrixFView& positions, const FrameSamples& samples, double frame,
                  Eigen::Ref<Eigen::RowVectorXf, 0, Eigen::InnerStride<>> position) {
    const int64_t last = positions.rows() - 1;
    const auto before = std::min(static_cast<int64_t>(frame) / samples.stride, last - 1);
    if (before < 0) {
        position = positions.row(0);
        return;
    }
    const int64_t after = before + 1;
    const int64_t left = std::max<int64_t>(before - 1, 0), right = std::min(after + 1, last);
    const auto frames = [&](int64_t from, int64_t to) {
        return static_cast<float>(samples.frame(to) - samples.frame(from));
    };
    const float width = frames(before, after);
    const float t = static_cast<float>(frame - static_cast<double>(samples.frame(before))) / width;
    const float rest = 1 - t;
    const float slope_before = width * t * rest * rest / frames(left, after);
    const float slope_after = -width * t * t * rest / frames(before, right);
    position = rest * rest * (1 + 2 * t) * positions.row(before) +
               t * t * (3 - 2 * t) * positions.row(after) +
               slope_before * (positions.row(after) - positions.row(left)) +
               slope_after * (positions.row(right) - positions.row(before));
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

int64_t FrameSamples::count() const {
    return frames == 0 ? 0 : (frames - 1 + stride - 1) / stride + 1;
}

int32_t sample_stride(double frame_rate) {
    constexpr double sample_rate = 15;
    return static_cast<int32_t>(std::max(1L, std::lround(frame_rate / sample_rate)));
}

MatrixF positions_between(const MatrixFView& positions, const FrameSamples& samples, double first,
                          double spacing, int64_t count) {
    MatrixF between(count, positions.cols());
    for (Eigen::Index i = 0; i < count; ++i) {
        const double last = static_cast<double>(samples.frames - 1);
        const double frame = std::clamp(first + static_cast<double>(i) * spacing, 0.0, last);
        put_position(positions, samples, frame, between.row(i));
    }
    return between;
}

PlacedSignature place_signature(Signature signature, const MatrixFView& poses, const MatrixF& axes,
                                int32_t stride) {
    if (poses.rows() != frame_count(signature)) {
        throw std::invalid_argument(fmt::format("{} poses were given for a signature of {} frames",
                                                poses.rows(), frame_count(signature)));
    }
    if (stride < 1) throw std::invalid_argument("poses are sampled at least one frame apart");
    PlacedSignature placed{std::move(signature), {}, stride, {}};
    placed.positions = positions_of(means_of(placed.runs, poses), axes);
    placed.sample_positions = positions_of(poses_at(placed.samples(), poses), axes);
    return placed;
}

}  // namespace kinetome
