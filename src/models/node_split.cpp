#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "level_growth.h"
#include "node_sums.h"
#include "plane.h"

namespace kinetome {
namespace {

/// Poses above a node's plane.
struct UpperHalf {
    int64_t count = 0;
    VectorD sum;  ///< p
};
void merge(UpperHalf& left, const UpperHalf& right) {
    left.count += right.count;
    left.sum += right.sum;
}
void pack(Packer& out, const UpperHalf& half) {
    out.put(half.count);
    pack(out, half.sum);
}
void unpack(Unpacker& in, UpperHalf& half) {
    unpack(in, half.count);
    unpack(in, half.sum);
}

/// Poses that would be on either side of a plane, copies included.
struct SideCounts {
    int64_t below = 0;
    int64_t above = 0;
};
void merge(SideCounts& left, const SideCounts& right) {
    left.below += right.below;
    left.above += right.above;
}
void pack(Packer& out, const SideCounts& counts) {
    out.put(counts.below).put(counts.above);
}
void unpack(Unpacker& in, SideCounts& counts) {
    unpack(in, counts.below);
    unpack(in, counts.above);
}

/// 2-means of one node.
struct Halving {
    int64_t count = 0;
    VectorD mean;      ///< p
    SplitPlane next;   ///< to be tried
    SplitPlane found;  ///< the last that was tried, with the gap between the halves it makes
    UpperHalf upper;   ///< that it makes
    bool settled = true;
};

Halving first_halving(const FittedNode& node, const std::vector<int32_t>& principal_columns) {
    Halving halving;
    halving.count = node.model.rows;
    halving.mean = node.model.mean(principal_columns);
    halving.next.normal = node.spread_along;
    halving.next.offset = node.spread_along.dot(halving.mean);
    halving.settled = false;
    return halving;
}

/// What of_node(node's rows here, principal values, halving) finds for each node with a slot.
template <class Value, class OfNode>
NodeSums<Value> sum_halvings(const GrowthPass& pass, const std::vector<int32_t>& slots,
                             const OfNode& of_node) {
    return sum_nodes<Value>(pass.workers, pass.principal.layout(), [&](const RowRange& piece) {
        pass.stop.check();
        NodeSums<Value> sums;
        const auto here = rows_by_node(pass.places.of(piece), pass.tree.first_open(), slots);
        if (here.empty()) return sums;
        const RowBlock principal = pass.principal.read(piece);
        for (const NodeRows& node : here) {
            sums.sums.emplace_back(node.slot, of_node(node, principal.view()));
        }
        return sums;
    });
}

UpperHalf upper_half(const SplitPlane& plane, const std::vector<int32_t>& rows,
                     const MatrixFView& principal) {
    UpperHalf half{0, VectorD::Zero(principal.cols())};
    VectorD values(principal.cols());
    for (const int32_t row : rows) {
        values = principal.row(row).cast<double>();
        if (along_normal(plane.normal.data(), values.data(), values.size()) - plane.offset > 0) {
            half.sum += values;
            ++half.count;
        }
    }
    return half;
}

/// Takes what the plane tried makes, and finds the next from it.
void go_on(Halving& halving, const UpperHalf& upper) {
    const bool parts = upper.count > 0 && upper.count < halving.count;
    const bool tried_before = halving.found.normal.size() > 0;
    if (!parts) {
        if (!tried_before) throw std::logic_error("a plane through the mean parts no poses");
        halving.settled = true;
        return;
    }
    const auto above = static_cast<double>(upper.count);
    const auto count = static_cast<double>(halving.count);
    const VectorD upper_mean = upper.sum / above;
    const VectorD lower_mean = (halving.mean * count - upper.sum) / (count - above);
    const VectorD gap = upper_mean - lower_mean;
    halving.settled =
        tried_before && upper.count == halving.upper.count && upper.sum == halving.upper.sum;
    halving.upper = upper;
    halving.found = halving.next;
    halving.found.half_gap = gap.norm() / 2;
    if (!(halving.found.half_gap > 0)) {
        halving.settled = true;
        return;
    }
    halving.next.normal = gap / gap.norm();
    halving.next.offset = halving.next.normal.dot((upper_mean + lower_mean) / 2);
}

std::vector<int32_t> unsettled_slots(const std::vector<Halving>& halvings) {
    std::vector<int32_t> slots;
    for (size_t i = 0; i < halvings.size(); ++i) {
        slots.push_back(halvings[i].settled ? -1 : static_cast<int32_t>(i));
    }
    return slots;
}

/// Lets the planes' bands overlap where no child would get nearly all poses.
void allow_overlap(const GrowthPass& pass, std::vector<Halving>& halvings,
                   const std::vector<int32_t>& slots) {
    const auto counts = sum_halvings<SideCounts>(
        pass, slots, [&](const NodeRows& node, const MatrixFView& principal) {
            const SplitPlane& plane = halvings[static_cast<size_t>(node.slot)].found;
            const double band = pass.options.overlap * plane.half_gap;
            SideCounts sides;
            VectorD values(principal.cols());
            for (const int32_t row : node.rows) {
                values = principal.row(row).cast<double>();
                const double distance =
                    along_normal(plane.normal.data(), values.data(), values.size()) - plane.offset;
                sides.above += distance > -band;
                sides.below += distance < band || distance <= 0;
            }
            return sides;
        });
    for (const auto& [node, sides] : counts.sums) {
        Halving& halving = halvings[static_cast<size_t>(node)];
        halving.found.overlaps = double(std::max(sides.below, sides.above)) <=
                                 pass.options.largest_share * double(halving.count);
    }
}

}  // namespace

std::vector<std::optional<SplitPlane>> split_nodes(const GrowthPass& pass,
                                                   const std::vector<FittedNode>& nodes) {
    std::vector<Halving> halvings(nodes.size());
    for (size_t i = 0; i < nodes.size(); ++i) {
        if (!nodes[i].may_be_leaf()) halvings[i] = first_halving(nodes[i], pass.principal_columns);
    }
    const std::vector<int32_t> split = unsettled_slots(halvings);
    for (int iteration = 0; iteration < pass.options.split_iterations; ++iteration) {
        const auto uppers = sum_halvings<UpperHalf>(
            pass, unsettled_slots(halvings),
            [&](const NodeRows& node, const MatrixFView& principal) {
                return upper_half(halvings[static_cast<size_t>(node.slot)].next, node.rows,
                                  principal);
            });
        if (uppers.sums.empty()) break;
        for (const auto& [node, upper] : uppers.sums) {
            go_on(halvings[static_cast<size_t>(node)], upper);
        }
    }
    if (pass.options.overlap > 0) allow_overlap(pass, halvings, split);

    std::vector<std::optional<SplitPlane>> planes(nodes.size());
    for (size_t i = 0; i < nodes.size(); ++i) {
        if (split[i] >= 0) planes[i] = halvings[i].found;
    }
    return planes;
}

}  // namespace kinetome
