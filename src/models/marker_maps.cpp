#include "kinetome/models/marker_maps.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "kinetome/math/symmetric_eigen.h"

namespace kinetome {
namespace {

constexpr double mm_per_cm = 10;

/// The solution of least norm of A x = b for a symmetric A without negative eigenvalues.
MatrixD least_norm_solution(const MatrixD& a, const MatrixD& b) {
    if (a.rows() == 0) return b;
    const SymmetricEigen eigen = symmetric_eigen(a);
    const double least = 1e-12 * std::max(eigen.values[0], 0.0);
    const VectorD inverse =
        eigen.values.unaryExpr([&](double v) { return v > least ? 1 / v : 0.0; });
    return eigen.vectors * (inverse.asDiagonal() * (eigen.vectors.transpose() * b));
}

/// What the parent's map weighs against those of `count` poses, as sums over poses. Noise is part
/// of every pose: a leaf's poses that differ by less than it do not tell where its map should
/// differ.
MatrixD parent_part(const MarkerMap* parent, int64_t principal, int64_t count,
                    const MarkerMapOptions& options) {
    const double noise = std::pow(options.noise / mm_per_cm, 2);
    const MatrixD identity = MatrixD::Identity(principal, principal);
    if (!parent) return noise * identity;
    return options.parent_weight * parent->principal_covariance +
           noise * (static_cast<double>(count) + options.parent_weight) * identity;
}

}  // namespace

MarkerMap fit_marker_map(const Moments& poses, const std::vector<int32_t>& principal_columns,
                         const MarkerMap* parent, const MarkerMapOptions& options) {
    const std::vector<int32_t> others = estimated_columns(poses.dimension(), principal_columns);
    const MatrixD inner = poses.scatter(principal_columns, principal_columns);
    const MatrixD between = poses.scatter(principal_columns, others);
    MarkerMap result;
    result.principal_covariance = inner / static_cast<double>(std::max<int64_t>(poses.count, 1));
    if (options.rule == MarkerMapRule::least_squares) {
        result.map = least_norm_solution(inner, between);
        return result;
    }
    const MatrixD weight = parent_part(parent, inner.rows(), poses.count, options);
    MatrixD target = between;
    if (parent) target.noalias() += weight * parent->map;
    result.map = MatrixD(inner + weight).llt().solve(target);
    return result;
}

std::vector<int32_t> estimated_columns(int64_t columns,
                                       const std::vector<int32_t>& principal_columns) {
    std::vector<int32_t> others;
    for (int32_t column = 0; column < columns; ++column) {
        if (!std::ranges::binary_search(principal_columns, column)) others.push_back(column);
    }
    return others;
}

VectorD estimate_pose(const PoseHierarchy& hierarchy, const MarkerMaps& maps,
                      const VectorD& principal, double band) {
    const std::vector<int32_t>& known = hierarchy.principal_columns;
    VectorD others = VectorD::Zero(static_cast<Eigen::Index>(maps.estimated_columns.size()));
    for (const LeafWeight& near : soft_leaves(hierarchy, principal, band)) {
        const VectorD mean = hierarchy.means.row(near.leaf);
        const VectorD from_mean = principal - mean(known);
        others += near.weight * (mean(maps.estimated_columns) +
                                 maps.maps[static_cast<size_t>(near.leaf)].transpose() * from_mean);
    }
    VectorD pose(hierarchy.columns());
    pose(known) = principal;
    pose(maps.estimated_columns) = others;
    return pose;
}

void pack(Packer& out, const MarkerMap& map) {
    pack(out, map.map);
    pack(out, map.principal_covariance);
}

void unpack(Unpacker& in, MarkerMap& map) {
    unpack(in, map.map);
    unpack(in, map.principal_covariance);
}

void pack(Packer& out, const MarkerMaps& maps) {
    pack(out, maps.estimated_columns);
    out.put(static_cast<uint64_t>(maps.maps.size()));
    for (const MatrixD& map : maps.maps) pack(out, map);
}

void unpack(Unpacker& in, MarkerMaps& maps) {
    unpack(in, maps.estimated_columns);
    maps.maps.resize(in.get<uint64_t>());
    for (MatrixD& map : maps.maps) unpack(in, map);
}

}  // namespace kinetome
