#include "kinetome/stages/pose_hierarchy_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinetome/base/error.h"

namespace kinetome {
namespace {

/// Of one pose's place in the tree.
constexpr uint64_t place_bytes = 8;

}  // namespace

int64_t expected_leaves(const HierarchySize& size, const PoseHierarchyOptions& options) {
    // Seconds a leaf of many subjects' varied motion at 20 mm and four dimensions, and how they
    // grow with both; half as many where every pose is to be within the tolerance. Frames between
    // those that are there already make no more leaves.
    constexpr double seconds_per_leaf = 0.6;
    const double seconds = seconds_per_leaf * std::pow(options.leaf_tolerance / 20, 1.75) *
                           std::pow(options.dimension / 4.0, 1.7);
    const double parts = options.leaf_rule == LeafRule::maximum ? 2 : 1;
    const double leaves = parts * size.seconds / std::max(seconds, 0.01);
    return std::clamp<int64_t>(std::llround(leaves), 1, std::max<int64_t>(size.rows, 1));
}

uint64_t leaf_bytes(const HierarchySize& size, const PoseHierarchyOptions& options) {
    const int64_t values = size.columns * (options.dimension + 1) +
                           size.principal * (size.columns - size.principal) + 2 * size.principal;
    return static_cast<uint64_t>(values) * sizeof(double);
}

uint64_t growth_bytes(const HierarchySize& size, const PoseHierarchyOptions& options) {
    // A level is held a second time while its checkpoint is written.
    constexpr double held = 1.5;
    const auto leaves = static_cast<double>(expected_leaves(size, options));
    return static_cast<uint64_t>(size.rows) * place_bytes +
           static_cast<uint64_t>(held * leaves * static_cast<double>(leaf_bytes(size, options)));
}

HierarchyMemory share_memory(const HierarchySize& size, const PoseHierarchyOptions& options,
                             const Resources& resources, int ranks) {
    constexpr uint64_t reserve = 32 << 20;  // readers, logs, what the heap does not give back
    constexpr uint64_t least_nodes = 16, most_nodes = 2048;
    const uint64_t per_node = pass_bytes_per_node(size.columns, resources.threads);
    const uint64_t at_rest = resident_bytes() + reserve;
    const uint64_t needed =
        at_rest + static_cast<uint64_t>(size.rows) * place_bytes + least_nodes * per_node;
    if (needed > resources.memory_bytes) {
        throw UsageError(fmt::format(
            "pose_hierarchy: {} poses need {} of memory at each rank, but {} are granted ({}): "
            "raise --memory",
            size.rows, describe_bytes(needed), describe_bytes(resources.memory_bytes),
            resources.memory_source));
    }
    uint64_t left = resources.memory_bytes - at_rest;
    const auto take = [&](uint64_t wanted) {
        const uint64_t taken = std::min(wanted, left);
        left -= taken;
        return taken;
    };
    take(growth_bytes(size, options));
    HierarchyMemory memory;
    const uint64_t nodes = std::clamp(left / 4 / per_node, least_nodes, most_nodes);
    memory.nodes_per_pass = static_cast<int64_t>(nodes);
    take(nodes * per_node);
    const auto share = static_cast<uint64_t>(size.rows / ranks + 1) * sizeof(float);
    memory.principal_bytes = take(share * static_cast<uint64_t>(size.principal));
    memory.pose_bytes = take(share * static_cast<uint64_t>(size.columns));
    return memory;
}

}  // namespace kinetome
