#include "kinetome/models/pose_hierarchy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "plane.h"

namespace kinetome {
namespace {

constexpr double mm_per_cm = 10;

auto as_vector(std::span<const float> pose) {
    return Eigen::Map<const VectorF>(pose.data(), static_cast<Eigen::Index>(pose.size()))
        .cast<double>();
}

/// How much of a pose belongs above a plane: 0 or 1 outside the band around it.
double share_above(double distance, double half_width) {
    if (half_width <= 0) return distance > 0 ? 1 : 0;
    return std::clamp(0.5 + distance / (2 * half_width), 0.0, 1.0);
}

void require_columns(const PoseHierarchy& hierarchy, int64_t columns) {
    if (columns == hierarchy.columns()) return;
    throw std::invalid_argument(fmt::format("poses of {} columns were given to a model of {}",
                                            columns, hierarchy.columns()));
}

std::span<const float> row_of(const MatrixFView& poses, int64_t row) {
    return {poses.data() + row * poses.outerStride(), static_cast<size_t>(poses.cols())};
}

}  // namespace

int64_t compared_markers(int64_t columns) {
    return std::max<int64_t>(columns / 3 - 1, 1);
}

VectorD principal_values(const PoseHierarchy& hierarchy, std::span<const float> pose) {
    VectorD values(static_cast<Eigen::Index>(hierarchy.principal_columns.size()));
    for (Eigen::Index i = 0; i < values.size(); ++i) {
        values[i] =
            double(pose[static_cast<size_t>(hierarchy.principal_columns[static_cast<size_t>(i)])]);
    }
    return values;
}

double distance_above(const PoseHierarchy& hierarchy, int32_t node, const VectorD& principal) {
    return along_normal(hierarchy.normals.data() + node * principal.size(), principal.data(),
                        principal.size()) -
           hierarchy.nodes[static_cast<size_t>(node)].offset;
}

int32_t leaf_of(const PoseHierarchy& hierarchy, const VectorD& principal) {
    int32_t at = 0;
    for (;;) {
        const HierarchyNode& node = hierarchy.nodes[static_cast<size_t>(at)];
        if (node.is_leaf()) return node.leaf;
        at = distance_above(hierarchy, at, principal) > 0 ? node.above : node.below;
    }
}

int32_t leaf_of(const PoseHierarchy& hierarchy, std::span<const float> pose) {
    return leaf_of(hierarchy, principal_values(hierarchy, pose));
}

std::vector<int32_t> leaves_of(const PoseHierarchy& hierarchy, const MatrixFView& poses) {
    require_columns(hierarchy, poses.cols());
    std::vector<int32_t> leaves;
    leaves.reserve(static_cast<size_t>(poses.rows()));
    for (int64_t i = 0; i < poses.rows(); ++i) {
        leaves.push_back(leaf_of(hierarchy, row_of(poses, i)));
    }
    return leaves;
}

std::vector<LeafWeight> soft_leaves(const PoseHierarchy& hierarchy, const VectorD& principal,
                                    double band) {
    struct Reached {
        int32_t node;
        double weight;
    };
    std::vector<LeafWeight> leaves;
    for (std::vector<Reached> open{{0, 1.0}}; !open.empty();) {
        const Reached at = open.back();
        open.pop_back();
        const HierarchyNode& node = hierarchy.nodes[static_cast<size_t>(at.node)];
        if (node.is_leaf()) {
            leaves.push_back({node.leaf, at.weight});
            continue;
        }
        const double above =
            share_above(distance_above(hierarchy, at.node, principal), band * node.half_gap);
        if (above > 0) open.push_back({node.above, at.weight * above});
        if (above < 1) open.push_back({node.below, at.weight * (1 - above)});
    }
    std::ranges::sort(leaves, {}, &LeafWeight::leaf);
    return leaves;
}

double leaf_distance(const PoseHierarchy& hierarchy, int32_t a, int32_t b) {
    const double squared = (hierarchy.means.row(a) - hierarchy.means.row(b)).squaredNorm();
    return mm_per_cm *
           std::sqrt(squared / static_cast<double>(compared_markers(hierarchy.columns())));
}

VectorD leaf_coordinates(const PoseHierarchy& hierarchy, int32_t leaf,
                         std::span<const float> pose) {
    require_columns(hierarchy, static_cast<int64_t>(pose.size()));
    const VectorD centred = as_vector(pose) - hierarchy.means.row(leaf).transpose();
    return hierarchy.basis(leaf).transpose() * centred;
}

VectorD pose_at(const PoseHierarchy& hierarchy, int32_t leaf, const VectorD& coordinates) {
    return hierarchy.means.row(leaf).transpose() + hierarchy.basis(leaf) * coordinates;
}

double pose_error(std::span<const float> pose, const VectorD& reconstructed) {
    const double squared = (as_vector(pose) - reconstructed).squaredNorm();
    return mm_per_cm *
           std::sqrt(squared / static_cast<double>(compared_markers(reconstructed.size())));
}

std::vector<double> leaf_errors(const PoseHierarchy& hierarchy, const MatrixFView& poses,
                                std::span<const int32_t> leaves) {
    std::vector<double> errors;
    errors.reserve(leaves.size());
    for (int64_t i = 0; i < poses.rows(); ++i) {
        const auto pose = row_of(poses, i);
        const int32_t leaf = leaves[static_cast<size_t>(i)];
        errors.push_back(
            pose_error(pose, pose_at(hierarchy, leaf, leaf_coordinates(hierarchy, leaf, pose))));
    }
    return errors;
}

void pack(Packer& out, const PoseHierarchy& hierarchy) {
    pack(out, hierarchy.principal_columns);
    out.put(static_cast<uint64_t>(hierarchy.nodes.size()));
    for (const HierarchyNode& node : hierarchy.nodes) {
        out.put(node.parent).put(node.below).put(node.above).put(node.leaf);
        out.put(node.rows).put(node.offset).put(node.half_gap);
    }
    pack(out, hierarchy.normals);
    pack(out, hierarchy.means);
    pack(out, hierarchy.bases);
    pack(out, hierarchy.leaf_errors);
    out.put(hierarchy.tolerance);
}

void unpack(Unpacker& in, PoseHierarchy& hierarchy) {
    unpack(in, hierarchy.principal_columns);
    hierarchy.nodes.clear();
    for (auto left = in.get<uint64_t>(); left > 0; --left) {
        HierarchyNode& node = hierarchy.nodes.emplace_back();
        unpack(in, node.parent);
        unpack(in, node.below);
        unpack(in, node.above);
        unpack(in, node.leaf);
        unpack(in, node.rows);
        unpack(in, node.offset);
        unpack(in, node.half_gap);
    }
    unpack(in, hierarchy.normals);
    unpack(in, hierarchy.means);
    unpack(in, hierarchy.bases);
    unpack(in, hierarchy.leaf_errors);
    unpack(in, hierarchy.tolerance);
}

}  // namespace kinetome
