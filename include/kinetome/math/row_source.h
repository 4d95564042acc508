// Rows of a matrix that need not be in memory: whoever sums or searches them reads runs of rows,
// and on a rank only those of its share.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"

namespace kinetome {

/// A run of rows (n × d): a view of memory that somebody else keeps, or rows kept here.
class RowBlock {
  public:
    explicit RowBlock(const MatrixFView& rows)
        : data_(rows.data()),
          rows_(rows.rows()),
          columns_(rows.cols()),
          stride_(rows.outerStride()) {}
    explicit RowBlock(std::shared_ptr<const MatrixF> rows) : RowBlock(MatrixFView(*rows)) {
        owner_ = std::move(rows);
    }
    explicit RowBlock(MatrixF rows) : RowBlock(std::make_shared<const MatrixF>(std::move(rows))) {}
    /// `count` of the rows of `owner`, from `first`.
    RowBlock(std::shared_ptr<const MatrixF> owner, int64_t first, int64_t count)
        : RowBlock(MatrixFView(owner->middleRows(first, count))) {
        owner_ = std::move(owner);
    }

    /// Valid as long as this block.
    Eigen::Map<const MatrixF, 0, Eigen::OuterStride<>> view() const {
        return {data_, rows_, columns_, Eigen::OuterStride<>(stride_)};
    }

  private:
    std::shared_ptr<const MatrixF> owner_;
    const float* data_;
    Eigen::Index rows_, columns_, stride_;
};

/// n × d values with the layout they are summed in.
class RowSource {
  public:
    virtual ~RowSource() = default;
    virtual int64_t columns() const = 0;
    virtual const PieceLayout& layout() const = 0;
    /// Thread-safe. A value does not depend on the range it is read in.
    virtual RowBlock read(const RowRange& range) const = 0;

    int64_t rows() const { return layout().rows(); }
};

/// Rows in memory. Refers to the matrix.
class MatrixRows final : public RowSource {
  public:
    /// Throws std::invalid_argument when the layout is one of another number of rows.
    MatrixRows(const MatrixFView& matrix, PieceLayout layout)
        : matrix_(matrix), layout_(std::move(layout)) {
        if (layout_.rows() != matrix.rows()) {
            throw std::invalid_argument("a layout of " + std::to_string(layout_.rows()) +
                                        " rows was given for a matrix of " +
                                        std::to_string(matrix.rows()));
        }
    }
    /// Not cut by clips.
    explicit MatrixRows(const MatrixFView& matrix)
        : MatrixRows(matrix, layout_rows(matrix.rows())) {}

    int64_t columns() const override { return matrix_.cols(); }
    const PieceLayout& layout() const override { return layout_; }
    RowBlock read(const RowRange& range) const override {
        return RowBlock(MatrixFView(matrix_.middleRows(range.first, range.size())));
    }

  private:
    MatrixFView matrix_;
    PieceLayout layout_;
};

}  // namespace kinetome
