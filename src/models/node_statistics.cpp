#include <algorithm>
#include <cmath>
#include <iterator>

#include "kinetome/base/parallel.h"
#include "kinetome/math/shifted_moments.h"
#include "kinetome/models/pose_hierarchy.h"
#include "level_growth.h"
#include "node_sums.h"

namespace kinetome {
namespace {

constexpr double mm_per_cm = 10;

/// slots[i] is the place of open node i in the nodes [first, end), -1 outside.
std::vector<int32_t> slots_of_run(size_t nodes, int64_t first, int64_t end) {
    std::vector<int32_t> slots(nodes, -1);
    for (int64_t i = first; i < end; ++i) slots[static_cast<size_t>(i)] = int32_t(i - first);
    return slots;
}

/// Moments of nodes, one a slot, each about its parent's mean.
NodeSums<ShiftedMoments> sum_moments(const GrowthPass& pass, const std::vector<int32_t>& slots,
                                     const std::vector<VectorD>& points) {
    return sum_nodes<ShiftedMoments>(pass.workers, pass.poses.layout(), [&](const RowRange& piece) {
        pass.stop.check();
        NodeSums<ShiftedMoments> sums;
        const auto nodes = rows_by_node(pass.places.of(piece), pass.tree.first_open(), slots);
        if (nodes.empty()) return sums;
        const RowBlock poses = pass.poses.read(piece);
        for (const NodeRows& node : nodes) {
            sums.sums.emplace_back(
                node.slot,
                shifted_moments(poses.view(), node.rows, points[static_cast<size_t>(node.slot)]));
        }
        return sums;
    });
}

/// Fits the slots of a run, dealt out to the ranks, and shares the results.
std::vector<FittedNode> fit_run(const GrowthPass& pass, const NodeSums<ShiftedMoments>& moments,
                                const std::vector<VectorD>& points,
                                const std::vector<const NodeModel*>& parents) {
    const int ranks = pass.workers.rank_count();
    std::vector<FittedNode> fitted(moments.sums.size());
    parallel_for(pass.workers.threads, static_cast<int64_t>(fitted.size()), [&](int64_t i) {
        if (i % ranks != pass.workers.rank()) return;
        const auto slot = static_cast<size_t>(i);
        const NodeModel* const parent = parents[slot];
        fitted[slot] =
            fit_node(about_mean(moments.sums[slot].second, points[slot]), pass.principal_columns,
                     parent ? &parent->map : nullptr, pass.options);
    });
    if (ranks == 1) return fitted;
    Packer mine;
    for (size_t i = 0; i < fitted.size(); ++i) {
        if (static_cast<int>(i) % ranks == pass.workers.rank()) pack(mine, fitted[i]);
    }
    const auto brought = pass.workers.ranks->gather_to_all(mine.take());
    for (int rank = 0; rank < ranks; ++rank) {
        Unpacker in(brought[static_cast<size_t>(rank)]);
        for (size_t i = static_cast<size_t>(rank); i < fitted.size();
             i += static_cast<size_t>(ranks)) {
            unpack(in, fitted[i]);
        }
    }
    return fitted;
}

/// Largest error of a node's poses, mm per marker.
struct LargestError {
    double error = 0;
};
void merge(LargestError& left, const LargestError& right) {
    left.error = std::max(left.error, right.error);
}
void pack(Packer& out, const LargestError& largest) {
    out.put(largest.error);
}
void unpack(Unpacker& in, LargestError& largest) {
    unpack(in, largest.error);
}

LargestError largest_error(const MatrixFView& poses, const std::vector<int32_t>& rows,
                           const NodeModel& model) {
    LargestError largest;
    for (const int32_t row : rows) {
        const std::span<const float> pose(poses.data() + row * poses.outerStride(),
                                          static_cast<size_t>(poses.cols()));
        const VectorD centred = poses.row(row).cast<double>().transpose() - model.mean;
        const VectorD rebuilt =
            model.mean + model.basis * VectorD(model.basis.transpose() * centred);
        largest.error = std::max(largest.error, pose_error(pose, rebuilt));
    }
    return largest;
}

}  // namespace

std::vector<FittedNode> fit_nodes(const GrowthPass& pass,
                                  const std::vector<const NodeModel*>& parents,
                                  int64_t nodes_per_pass) {
    const auto open = static_cast<int64_t>(parents.size());
    std::vector<FittedNode> fitted;
    for (int64_t first = 0; first < open; first += nodes_per_pass) {
        const int64_t end = std::min(first + nodes_per_pass, open);
        const std::vector<const NodeModel*> run(parents.begin() + first, parents.begin() + end);
        std::vector<VectorD> points;
        for (const NodeModel* parent : run) {
            points.push_back(parent
                                 ? parent->mean
                                 : VectorD(pass.poses.read({0, 1}).view().row(0).cast<double>()));
        }
        const auto moments = sum_moments(pass, slots_of_run(parents.size(), first, end), points);
        std::ranges::move(fit_run(pass, moments, points, run), std::back_inserter(fitted));
    }
    return fitted;
}

void refuse_poses_beyond(const GrowthPass& pass, std::vector<FittedNode>& nodes) {
    std::vector<int32_t> slots(nodes.size(), -1);
    for (size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].may_be_leaf() && nodes[i].can_split()) slots[i] = static_cast<int32_t>(i);
    }
    const auto errors =
        sum_nodes<LargestError>(pass.workers, pass.poses.layout(), [&](const RowRange& piece) {
            pass.stop.check();
            NodeSums<LargestError> sums;
            const auto here = rows_by_node(pass.places.of(piece), pass.tree.first_open(), slots);
            if (here.empty()) return sums;
            const RowBlock poses = pass.poses.read(piece);
            for (const NodeRows& node : here) {
                sums.sums.emplace_back(node.slot,
                                       largest_error(poses.view(), node.rows,
                                                     nodes[static_cast<size_t>(node.slot)].model));
            }
            return sums;
        });
    for (const auto& [node, largest] : errors.sums) {
        if (largest.error <= pass.options.leaf_tolerance) continue;
        nodes[static_cast<size_t>(node)].model.basis.resize(0, 0);
    }
}

}  // namespace kinetome
