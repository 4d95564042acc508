// Rows in blocks of eight, and boxes around them: blocks of consecutive rows, eight blocks to a
// node, eight nodes to the next. Motion moves on a little from row to row, so that the boxes are
// tight.
#pragma once

#include <cstdint>
#include <vector>

#include "kinetome/base/matrix.h"
#include "knn_axes.h"
#include "knn_lanes.h"

namespace kinetome {

class RowBlocks {
  public:
    RowBlocks(const MatrixFView& rows, int threads);

    int64_t rows() const { return rows_; }
    int64_t columns() const { return columns_; }
    int64_t blocks() const { return count_at(0); }
    const LeadingAxes& axes() const { return axes_; }

    /// columns() × 8: the rows of a block. The last block repeats the last row.
    const float* values(int64_t block) const { return values_.data() + block * columns_ * octet; }
    /// axes().dimension() × (lowest, highest): the box around a block, with room for the slack.
    const float* box(int64_t block) const { return outlines_.data() + block * outline_size(); }
    /// axes().dimension() × 8: the rows of a block, projected.
    const float* projected(int64_t block) const { return box(block) + box_size(); }
    /// How far a row of the block may lie from its true projection, at most.
    float slack(int64_t block) const { return slack_[static_cast<size_t>(block)]; }

    /// Boxes of level 0 hold a block, those of a higher level eight boxes of the level below. The
    /// highest level has at most eight.
    int levels() const { return static_cast<int>(boxes_.size()); }
    int64_t count_at(int level) const { return (rows_ + rows_in(level) - 1) / rows_in(level); }
    static int64_t rows_in(int level) { return octet << (3 * level); }
    /// axes().dimension() × (8 lowest, 8 highest): eight neighbouring boxes, with room for the
    /// slack. Boxes that do not exist repeat the last.
    const float* boxes(int level, int64_t group) const {
        return boxes_[static_cast<size_t>(level)].data() + group * axes_.dimension() * 2 * octet;
    }

  private:
    int64_t box_size() const { return (2 * axes_.dimension() + octet - 1) / octet * octet; }
    int64_t outline_size() const { return box_size() + axes_.dimension() * octet; }
    void fill_blocks(const MatrixFView& rows, int64_t first_block, int64_t end_block);
    void set_box(int level, int64_t box, const float* lowest, const float* highest);
    void enclose_boxes_below(int level);

    int64_t rows_;
    int64_t columns_;
    LeadingAxes axes_;
    LaneBuffer values_;
    LaneBuffer outlines_;  ///< boxes and projected rows: they are looked at together
    std::vector<float> slack_;
    std::vector<LaneBuffer> boxes_;
};

}  // namespace kinetome
