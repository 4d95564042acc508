#include "knn_blocks.h"

#include <algorithm>

#include "kinetome/base/parallel.h"

namespace kinetome {
namespace {

constexpr int64_t blocks_at_once = 64;

int64_t octets(int64_t count) {
    return (count + octet - 1) / octet;
}

/// Row r of `rows` to lane r, the last one to the lanes beyond.
void to_lanes(const MatrixFView& rows, float* lanes) {
    for (int64_t lane = 0; lane < octet; ++lane) {
        const int64_t row = std::min(lane, rows.rows() - 1);
        for (int64_t j = 0; j < rows.cols(); ++j) lanes[j * octet + lane] = rows(row, j);
    }
}

}  // namespace

RowBlocks::RowBlocks(const MatrixFView& rows, int threads)
    : rows_(rows.rows()), columns_(rows.cols()), axes_(rows) {
    values_.resize(static_cast<size_t>(blocks() * columns_ * octet));
    outlines_.resize(static_cast<size_t>(blocks() * outline_size()));
    slack_.resize(static_cast<size_t>(blocks()));
    for (int64_t boxes = blocks(); boxes > 0; boxes = boxes > octet ? octets(boxes) : 0) {
        boxes_.emplace_back(static_cast<size_t>(octets(boxes) * axes_.dimension() * 2 * octet));
    }
    parallel_for(threads, (blocks() + blocks_at_once - 1) / blocks_at_once, [&](int64_t part) {
        const int64_t first = part * blocks_at_once;
        fill_blocks(rows, first, std::min(first + blocks_at_once, blocks()));
    });
    for (int level = 1; level < levels(); ++level) enclose_boxes_below(level);
}

void RowBlocks::fill_blocks(const MatrixFView& rows, int64_t first_block, int64_t end_block) {
    const int64_t first_row = first_block * octet, end_row = std::min(end_block * octet, rows_);
    MatrixF projected;
    VectorF slack;
    axes_.project(rows.middleRows(first_row, end_row - first_row), projected, slack);
    for (int64_t block = first_block; block < end_block; ++block) {
        const int64_t row = block * octet, count = std::min(octet, rows_ - row);
        const auto of_block = projected.middleRows(row - first_row, count);
        const float room = slack.segment(row - first_row, count).maxCoeff();
        float* const box = outlines_.data() + block * outline_size();
        to_lanes(of_block, box + box_size());
        to_lanes(rows.middleRows(row, count), values_.data() + block * columns_ * octet);
        slack_[static_cast<size_t>(block)] = room;
        const VectorF lowest = of_block.colwise().minCoeff().array() - room;
        const VectorF highest = of_block.colwise().maxCoeff().array() + room;
        for (int64_t i = 0; i < axes_.dimension(); ++i) {
            box[2 * i] = lowest[i];
            box[2 * i + 1] = highest[i];
        }
        set_box(0, block, lowest.data(), highest.data());
    }
}

void RowBlocks::set_box(int level, int64_t box, const float* lowest, const float* highest) {
    float* const group =
        boxes_[static_cast<size_t>(level)].data() + box / octet * axes_.dimension() * 2 * octet;
    const int64_t end_lane = box + 1 == count_at(level) ? octet : box % octet + 1;
    for (int64_t i = 0; i < axes_.dimension(); ++i) {
        for (int64_t lane = box % octet; lane < end_lane; ++lane) {
            group[2 * i * octet + lane] = lowest[i];
            group[(2 * i + 1) * octet + lane] = highest[i];
        }
    }
}

void RowBlocks::enclose_boxes_below(int level) {
    std::vector<float> lowest(static_cast<size_t>(axes_.dimension())), highest(lowest.size());
    for (int64_t box = 0; box < count_at(level); ++box) {
        const float* const below = boxes(level - 1, box);
        for (size_t i = 0; i < lowest.size(); ++i) {
            const float* const low = below + 2 * i * octet;
            lowest[i] = *std::min_element(low, low + octet);
            highest[i] = *std::max_element(low + octet, low + 2 * octet);
        }
        set_box(level, box, lowest.data(), highest.data());
    }
}

}  // namespace kinetome
