#include "growing_tree.h"

#include <algorithm>
#include <cmath>

#include "plane.h"

namespace kinetome {

void GrowingTree::add(const HierarchyLevel& level) {
    auto next = static_cast<int32_t>(nodes_.size() + level.size());
    for (const GrownNode& grown : level) {
        Node& node = nodes_.emplace_back();
        normals_.resize(nodes_.size() * static_cast<size_t>(columns_), 0.0);
        if (!grown.split) continue;
        node.below = next;
        node.offset = grown.split->offset;
        node.band = grown.split->overlaps ? overlap_ * grown.split->half_gap : 0;
        std::ranges::copy(grown.split->normal, normals_.end() - columns_);
        next += 2;
    }
}

double GrowingTree::distance_above(int32_t node, const double* principal) const {
    return along_normal(normals_.data() + node * columns_, principal, columns_) -
           nodes_[static_cast<size_t>(node)].offset;
}

PosePlaces::PosePlaces(const RowSource& principal, const GrowingTree& tree)
    : principal_(principal), tree_(tree), places_(principal.layout().pieces.size()) {}

bool PosePlaces::can_move(const std::vector<PosePlace>& places) const {
    return std::ranges::any_of(places,
                               [&](const PosePlace& at) { return tree_.is_split(at.node); });
}

void PosePlaces::move_down(const PosePlace& from, const double* principal,
                           std::vector<PosePlace>& to) const {
    PosePlace at = from;
    while (tree_.is_split(at.node)) {
        const double distance = tree_.distance_above(at.node, principal);
        const int32_t below = tree_.below(at.node);
        const int32_t own = distance > 0 ? below + 1 : below;
        if (!at.is_copy && std::abs(distance) < tree_.band(at.node)) {
            const int32_t other = distance > 0 ? below : below + 1;
            move_down({other, at.row, true}, principal, to);
        }
        at.node = own;
    }
    to.push_back(at);
}

std::span<const PosePlace> PosePlaces::of(const RowRange& piece) const {
    const auto& pieces = principal_.layout().pieces;
    const auto number = std::ranges::lower_bound(pieces, piece.first, {}, &RowRange::first);
    auto& places = places_[static_cast<size_t>(number - pieces.begin())];
    if (places.empty()) {
        for (int64_t row = 0; row < piece.size(); ++row) {
            places.push_back({0, static_cast<uint16_t>(row), false});
        }
    }
    if (!can_move(places)) return places;
    const RowBlock block = principal_.read(piece);
    std::vector<PosePlace> moved;
    moved.reserve(places.size());
    VectorD values;
    for (const PosePlace& at : places) {
        if (tree_.is_split(at.node)) values = block.view().row(at.row).cast<double>();
        move_down(at, values.data(), moved);
    }
    places = std::move(moved);
    return places;
}

std::vector<NodeRows> rows_by_node(std::span<const PosePlace> places, int32_t first,
                                   const std::vector<int32_t>& slots) {
    std::vector<std::pair<int32_t, int32_t>> found;  // slot, row
    for (const PosePlace& at : places) {
        const int64_t open = at.node - first;
        if (open < 0 || slots[static_cast<size_t>(open)] < 0) continue;
        found.emplace_back(slots[static_cast<size_t>(open)], at.row);
    }
    std::ranges::sort(found);
    std::vector<NodeRows> result;
    for (const auto& [slot, row] : found) {
        if (result.empty() || result.back().slot != slot) result.push_back({slot, {}});
        result.back().rows.push_back(row);
    }
    return result;
}

}  // namespace kinetome
