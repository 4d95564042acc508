#include "knn_tile.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace kinetome {
namespace {

using FloatLimits = std::numeric_limits<float>;

/// A comparison with the square of a reach; the least normal float covers what underflows.
float squared_with_room(float reach) {
    return reach * reach + FloatLimits::min();
}

/// The lanes of a block that begins at `block_row` which hold `row` and later rows.
uint32_t lanes_from(int64_t row, int64_t block_row) {
    return 0xFFU << std::clamp<int64_t>(row - block_row, 0, octet) & 0xFFU;
}

}  // namespace

// A sum of p squared differences is off by at most (p + 2) half epsilons of itself, the distance by
// half of that: the factor has room for as much in the reach, and for sums in double.
QueryTile::QueryTile(const RowBlocks& blocks, int64_t most)
    : blocks_(blocks),
      most_(most),
      dimension_(blocks.axes().dimension()),
      rounding_(1 + static_cast<float>(dimension_ + 8) * FloatLimits::epsilon()),
      values_(static_cast<size_t>(octet * blocks.columns())),
      projected_(static_cast<size_t>(octet * dimension_)),
      box_(static_cast<size_t>(2 * dimension_)) {}

void QueryTile::search(const MatrixFView& queries, std::span<const double> squared_limits,
                       std::span<const RowRange> excluded) {
    load(queries, squared_limits, excluded);
    queue_.clear();
    if (blocks_.levels() > 0) push_boxes(blocks_.levels() - 1, 0);
    while (!queue_.empty()) {
        const Node nearest = pop();
        if (is_out_of_reach(nearest)) break;
        if (nearest.level() == 0) {
            visit(nearest.box());
        } else {
            push_boxes(nearest.level() - 1, nearest.box());
        }
    }
}

void QueryTile::load(const MatrixFView& queries, std::span<const double> squared_limits,
                     std::span<const RowRange> excluded) {
    size_ = queries.rows();
    MatrixF projected;
    VectorF slack;
    blocks_.axes().project(queries, projected, slack);
    load_projected(projected, slack);
    std::fill(squared_reach_, squared_reach_ + octet, -1.0F);
    for (size_t q = 0; q < size_t(size_); ++q) {
        const auto row = static_cast<int64_t>(q);
        for (int64_t j = 0; j < queries.cols(); ++j) {
            values_[q * size_t(queries.cols()) + size_t(j)] = double(queries(row, j));
        }
        slack_[q] = slack[row];
        excluded_[q] = excluded.empty() ? RowRange{} : excluded[q];
        nearest_[q].reset(most_, squared_limits[q]);
        set_reach(q);
    }
}

void QueryTile::load_projected(const MatrixF& projected, const VectorF& slack) {
    for (int64_t i = 0; i < dimension_; ++i) {
        for (int64_t lane = 0; lane < octet; ++lane) {
            projected_[size_t(i * octet + lane)] = projected(std::min(lane, size_ - 1), i);
        }
        box_[size_t(2 * i)] = projected.col(i).minCoeff() - slack.maxCoeff();
        box_[size_t(2 * i + 1)] = projected.col(i).maxCoeff() + slack.maxCoeff();
    }
}

void QueryTile::set_reach(size_t query) {
    const double distance = std::sqrt(nearest_[query].limit().squared);
    const double most = FloatLimits::max();
    reach_[query] = static_cast<float>(std::min(distance, most)) * rounding_ + slack_[query];
    squared_reach_[query] = squared_with_room(reach_[query]);
    largest_squared_reach_ = *std::max_element(squared_reach_, squared_reach_ + octet);
}

void QueryTile::push_boxes(int level, int64_t group) {
    const float* boxes = blocks_.boxes(level, group);
    FloatOctet squared{};
    for (int64_t i = 0; i < dimension_; ++i, boxes += 2 * octet) {
        const FloatOctet gap = gap_between(load_octet(boxes) - box_[size_t(2 * i + 1)],
                                           box_[size_t(2 * i)] - load_octet(boxes + octet));
        squared += gap * gap;
    }
    const int64_t first = group * octet, count = std::min(octet, blocks_.count_at(level) - first);
    for (int64_t lane = 0; lane < count; ++lane) {
        if (squared[lane] > largest_squared_reach_) continue;
        queue_.emplace_back(squared[lane], level, first + lane);
        std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
    }
}

QueryTile::Node QueryTile::pop() {
    std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
    const Node node = queue_.back();
    queue_.pop_back();
    if (!queue_.empty()) prefetch(queue_.front());
    return node;
}

void QueryTile::prefetch(const Node& node) const {
    const auto ask_for = [](const float* from, const float* end) {
        constexpr int64_t cache_line = 64 / sizeof(float);
        for (; from < end; from += cache_line) __builtin_prefetch(from);
    };
    if (node.level() == 0) {
        ask_for(blocks_.box(node.box()), blocks_.projected(node.box()) + octet * dimension_);
    } else {
        const float* const boxes = blocks_.boxes(node.level() - 1, node.box());
        ask_for(boxes, boxes + 2 * octet * dimension_);
    }
}

bool QueryTile::is_out_of_reach(const Node& node) const {
    if (node.squared_gap() > largest_squared_reach_) return true;
    if (node.squared_gap() > 0) return false;
    for (size_t q = 0; q < size_t(size_); ++q) {
        if (!wants_none_from(q, node.first_block())) return false;
    }
    return true;
}

bool QueryTile::wants_none_from(size_t query, int64_t block) const {
    return nearest_[query].limit() < Neighbour{0, static_cast<int32_t>(block * octet)};
}

void QueryTile::visit(int64_t block) {
    for (uint32_t queries = queries_near(block); queries != 0; queries &= queries - 1) {
        const auto q = static_cast<size_t>(std::countr_zero(queries));
        if (wants_none_from(q, block)) continue;
        uint32_t rows = rows_near(block, q) & rows_allowed(block, q);
        if (rows == 0) continue;
        double squared[octet];
        measure(block, q, squared);
        bool nearer = false;
        for (; rows != 0; rows &= rows - 1) {
            const int lane = std::countr_zero(rows);
            nearer |=
                nearest_[q].offer({squared[lane], static_cast<int32_t>(block * octet + lane)});
        }
        if (nearer) set_reach(q);
    }
}

uint32_t QueryTile::queries_near(int64_t block) const {
    const float* box = blocks_.box(block);
    FloatOctet squared{};
    for (int64_t i = 0; i < dimension_; ++i, box += 2) {
        const FloatOctet at = load_octet(projected_.data() + i * octet);
        const FloatOctet gap = gap_between(box[0] - at, at - box[1]);
        squared += gap * gap;
    }
    return ~octet_greater(squared, load_octet(squared_reach_)) & 0xFFU;
}

uint32_t QueryTile::rows_near(int64_t block, size_t query) const {
    const float* rows = blocks_.projected(block);
    const float* at = projected_.data() + query;
    FloatOctet squared{};
    for (int64_t i = 0; i < dimension_; ++i, rows += octet, at += octet) {
        const FloatOctet difference = load_octet(rows) - *at;
        squared += difference * difference;
    }
    const float most = squared_with_room(reach_[query] + blocks_.slack(block));
    return ~octet_greater(squared, FloatOctet{} + most) & 0xFFU;
}

uint32_t QueryTile::rows_allowed(int64_t block, size_t query) const {
    const int64_t row = block * octet;
    const uint32_t excluded =
        lanes_from(excluded_[query].first, row) & ~lanes_from(excluded_[query].end, row);
    return ~excluded & ~lanes_from(blocks_.rows(), row);
}

void QueryTile::measure(int64_t block, size_t query, double (&squared)[octet]) const {
    const float* rows = blocks_.values(block);
    const double* const at = values_.data() + int64_t(query) * blocks_.columns();
    DoubleQuartet low{}, high{};
    for (int64_t j = 0; j < blocks_.columns(); ++j, rows += octet) {
        const DoubleQuartet low_difference = load_quartet(rows) - at[j];
        const DoubleQuartet high_difference = load_quartet(rows + 4) - at[j];
        low += low_difference * low_difference;
        high += high_difference * high_difference;
    }
    std::memcpy(squared, &low, sizeof low);
    std::memcpy(squared + 4, &high, sizeof high);
}

}  // namespace kinetome
