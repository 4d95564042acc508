#include "kinetome/models/hierarchy_growth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "growing_tree.h"
#include "kinetome/math/shifted_moments.h"
#include "level_growth.h"
#include "node_sums.h"

namespace kinetome {
namespace {

/// The first value that is not finite, by place in the matrix.
struct NotFinite {
    int64_t place = 0;
};
void pack(Packer& out, const NotFinite& found) {
    out.put(found.place);
}
void unpack(Unpacker& in, NotFinite& found) {
    unpack(in, found.place);
}

void require_finite(const RowSource& poses, const Workers& workers) {
    constexpr int64_t none = std::numeric_limits<int64_t>::max();
    const auto first = sum_pieces<NotFinite>(
        workers, poses.layout(),
        [&](const RowRange& piece) {
            const RowBlock block = poses.read(piece);
            for (int64_t i = 0; i < piece.size(); ++i) {
                if (block.view().row(i).allFinite()) continue;
                for (int64_t j = 0;; ++j) {
                    if (!std::isfinite(block.view()(i, j))) {
                        return NotFinite{(piece.first + i) * poses.columns() + j};
                    }
                }
            }
            return NotFinite{none};
        },
        [](NotFinite& left, const NotFinite& right) {
            left.place = std::min(left.place, right.place);
        });
    if (!first || first->place == none) return;
    throw std::invalid_argument(fmt::format("pose {} has a value that is not finite in column {}",
                                            first->place / poses.columns(),
                                            first->place % poses.columns()));
}

/// Parents of the nodes of the level after `last`; null above the root.
std::vector<const NodeModel*> parents_below(const HierarchyLevel* last) {
    if (!last) return {nullptr};
    std::vector<const NodeModel*> parents;
    for (const GrownNode& node : *last) {
        if (node.split) parents.insert(parents.end(), 2, &node.model);
    }
    return parents;
}

HierarchyLevel grow_level(const GrowthPass& pass, const std::vector<const NodeModel*>& parents,
                          int64_t nodes_per_pass) {
    std::vector<FittedNode> fitted = fit_nodes(pass, parents, nodes_per_pass);
    if (pass.options.leaf_rule == LeafRule::maximum) refuse_poses_beyond(pass, fitted);
    auto planes = split_nodes(pass, fitted);
    HierarchyLevel level;
    for (size_t i = 0; i < fitted.size(); ++i) {
        level.push_back({std::move(fitted[i].model), std::move(planes[i])});
        if (!level.back().split) level.back().model.map.principal_covariance.resize(0, 0);
    }
    return level;
}

/// What only children need, once they are there.
void forget_split_models(HierarchyLevel& level) {
    for (GrownNode& node : level) {
        if (node.split) node.model = {node.model.rows, {}, 0, {}, {}};
    }
}

struct Sizes {
    int64_t nodes = 0;
    int64_t leaves = 0;
};

Sizes sizes_of(const std::vector<HierarchyLevel>& levels) {
    Sizes sizes;
    for (const HierarchyLevel& level : levels) {
        sizes.nodes += static_cast<int64_t>(level.size());
        sizes.leaves += std::ranges::count_if(level, [](const auto& node) { return !node.split; });
    }
    return sizes;
}

/// The levels as one tree; takes the models out of them.
GrownHierarchy assembled(std::vector<HierarchyLevel> levels, int64_t columns,
                         const std::vector<int32_t>& principal_columns,
                         const PoseHierarchyOptions& options) {
    const Sizes sizes = sizes_of(levels);
    GrownHierarchy grown;
    PoseHierarchy& tree = grown.hierarchy;
    tree.principal_columns = principal_columns;
    tree.tolerance = options.leaf_tolerance;
    tree.nodes.resize(static_cast<size_t>(sizes.nodes));
    tree.normals = MatrixD::Zero(sizes.nodes, static_cast<int64_t>(principal_columns.size()));
    tree.means.resize(sizes.leaves, columns);
    tree.bases.resize(sizes.leaves * columns, options.dimension);
    tree.leaf_errors.resize(sizes.leaves);
    grown.maps.estimated_columns = estimated_columns(columns, principal_columns);

    int32_t number = 0, leaf = 0;
    for (HierarchyLevel& level : levels) {
        auto child = number + static_cast<int32_t>(level.size());
        for (GrownNode& one : level) {
            HierarchyNode& node = tree.nodes[static_cast<size_t>(number)];
            node.rows = one.model.rows;
            if (one.split) {
                node.below = child++;
                node.above = child++;
                tree.nodes[static_cast<size_t>(node.below)].parent = number;
                tree.nodes[static_cast<size_t>(node.above)].parent = number;
                node.offset = one.split->offset;
                node.half_gap = one.split->half_gap;
                tree.normals.row(number) = one.split->normal;
            } else {
                node.leaf = leaf;
                tree.means.row(leaf) = one.model.mean;
                tree.bases.middleRows(leaf * columns, columns) = one.model.basis;
                tree.leaf_errors[leaf] = one.model.error;
                grown.maps.maps.push_back(std::move(one.model.map.map));
                ++leaf;
            }
            ++number;
        }
        level.clear();
    }
    return grown;
}

void check(const RowSource& poses, const RowSource& principal,
           const std::vector<int32_t>& principal_columns, const PoseHierarchyOptions& options,
           int64_t nodes_per_pass) {
    if (poses.rows() == 0) throw std::invalid_argument("there are no poses to make a hierarchy of");
    if (principal.rows() != poses.rows() ||
        principal.columns() != static_cast<int64_t>(principal_columns.size())) {
        throw std::invalid_argument("the principal values are not those of the poses");
    }
    if (options.dimension < 1 || !(options.leaf_tolerance > 0) || options.split_iterations < 1 ||
        nodes_per_pass < 1) {
        throw std::invalid_argument(
            "dimension, leaf tolerance, iterations and nodes per pass must be positive");
    }
}

}  // namespace

uint64_t pass_bytes_per_node(int64_t columns, int threads) {
    // Complete sums wait at the upper nodes of the tree of pieces, and each thread merges two.
    const auto sums = static_cast<uint64_t>(4 + 2 * threads);
    return sums * static_cast<uint64_t>(shifted_moment_bytes(columns));
}

GrownHierarchy grow_pose_hierarchy(const RowSource& poses, const RowSource& principal,
                                   const std::vector<int32_t>& principal_columns,
                                   const PoseHierarchyOptions& options, const Workers& workers,
                                   int64_t nodes_per_pass, const StopToken& stop,
                                   const GrowthCheckpoints& checkpoints) {
    check(poses, principal, principal_columns, options, nodes_per_pass);
    GrowingTree tree(principal.columns(), options.overlap);
    const PosePlaces places(principal, tree);
    const GrowthPass pass{poses,  principal, principal_columns, options, workers, tree,
                          places, stop};
    std::vector<HierarchyLevel> levels;
    for (;;) {
        const auto parents = parents_below(levels.empty() ? nullptr : &levels.back());
        if (parents.empty()) break;
        const auto depth = static_cast<int>(levels.size());
        std::optional<HierarchyLevel> level = checkpoints.load(depth);
        if (!level) {
            if (levels.empty()) require_finite(poses, workers);
            level = grow_level(pass, parents, nodes_per_pass);
            checkpoints.save(depth, *level);
        }
        tree.add(*level);
        if (!levels.empty()) forget_split_models(levels.back());
        levels.push_back(*std::move(level));
    }
    return assembled(std::move(levels), poses.columns(), principal_columns, options);
}

void pack(Packer& out, const GrownHierarchy& grown) {
    pack(out, grown.hierarchy);
    pack(out, grown.maps);
}

void unpack(Unpacker& in, GrownHierarchy& grown) {
    unpack(in, grown.hierarchy);
    unpack(in, grown.maps);
}

void pack(Packer& out, const NodeModel& model) {
    out.put(model.rows).put(model.error);
    pack(out, model.mean);
    pack(out, model.basis);
    pack(out, model.map);
}

void unpack(Unpacker& in, NodeModel& model) {
    unpack(in, model.rows);
    unpack(in, model.error);
    unpack(in, model.mean);
    unpack(in, model.basis);
    unpack(in, model.map);
}

void pack(Packer& out, const HierarchyLevel& level) {
    out.put(static_cast<uint64_t>(level.size()));
    for (const GrownNode& node : level) {
        pack(out, node.model);
        out.put<uint8_t>(node.split.has_value());
        if (!node.split) continue;
        pack(out, node.split->normal);
        out.put(node.split->offset).put(node.split->half_gap);
        out.put<uint8_t>(node.split->overlaps);
    }
}

void unpack(Unpacker& in, HierarchyLevel& level) {
    level.clear();
    for (auto left = in.get<uint64_t>(); left > 0; --left) {
        GrownNode& node = level.emplace_back();
        unpack(in, node.model);
        if (!in.get<uint8_t>()) continue;
        SplitPlane& split = node.split.emplace();
        unpack(in, split.normal);
        unpack(in, split.offset);
        unpack(in, split.half_gap);
        split.overlaps = in.get<uint8_t>();
    }
}

}  // namespace kinetome
