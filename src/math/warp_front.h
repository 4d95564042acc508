// The latest rows of a warping table: all that the next row of it depends on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"

namespace kinetome {

/// A step over the table, with what the cell it comes to weighs.
struct TableStep {
    int32_t rows = 1;
    int32_t columns = 1;
    double weight = 1;
};

/// Paths may begin in columns [0, columns) of a row, a cell weighing weight + column · per_column.
struct TableStart {
    int64_t columns = 0;
    double weight = 1;
    double per_column = 0;
};

class WarpFront {
  public:
    static constexpr uint8_t begins_here = 255;

    /// `sequence` (m × d) runs along the columns and is copied.
    WarpFront(const MatrixFView& sequence, std::vector<TableStep> steps);

    /// Computes the next row of the table in the given columns, and leaves the others unreachable.
    void advance(const float* row, const RowRange& columns, const TableStart& start);

    /// Of the row `back` rows before the latest, which is less than depth(): the least cost of a
    /// path to each column, infinite where there is none.
    std::span<const double> totals(int64_t back = 0) const;
    /// Of the latest row: by which step the path comes, or begins_here. Nothing sensible where
    /// there is no path.
    std::span<const uint8_t> choices() const { return choices_; }
    std::span<const double> distances() const { return distances_; }

    std::span<const TableStep> steps() const { return steps_; }
    int64_t columns() const { return columns_; }
    /// Rows that a step may reach back, and the latest.
    int64_t depth() const { return depth_; }

  private:
    void measure(const float* row, const RowRange& columns);
    double* ring_row(int64_t row);

    int64_t columns_, dimension_;
    std::vector<TableStep> steps_;
    int64_t depth_ = 1;
    int64_t rows_ = 0;
    std::vector<double> blocks_;  ///< the sequence, 8 rows at a time with their lanes side by side
    std::vector<double> distances_;
    std::vector<double> ring_;
    std::vector<uint8_t> choices_;
};

}  // namespace kinetome
