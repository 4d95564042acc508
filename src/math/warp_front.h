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
    static constexpr uint8_t begins_here = 0;

    /// `sequence` (m × d) runs along the columns and is copied. No path leads through a cell whose
    /// distance is greater than the radius.
    WarpFront(const MatrixFView& sequence, std::vector<TableStep> steps, double radius,
              bool with_choices);
    /// Of a table whose distances are given row by row.
    WarpFront(int64_t columns, std::vector<TableStep> steps, double radius, bool with_choices);

    /// Computes the next row of the table in the given columns, and leaves the others unreachable.
    void advance(const float* row, const RowRange& columns, const TableStart& start);
    /// The same from the distances of its cells.
    void advance(const double* distances, const RowRange& columns, const TableStart& start);

    /// Of the row `back` rows before the latest, which is less than depth(): the least cost of a
    /// path to each column, infinite where there is none.
    std::span<const double> totals(int64_t back = 0) const {
        return {ring_row(rows_ - 1 - back), static_cast<size_t>(columns_)};
    }
    /// Of the latest row: by which step the path comes, counted from 1, or begins_here. Of what
    /// costs the same the lowest. Empty unless asked for.
    std::span<const uint8_t> choices() const { return choices_; }
    /// Infinite beyond the radius.
    std::span<const double> distances() const { return distances_; }

    std::span<const TableStep> steps() const { return steps_; }
    int64_t columns() const { return columns_; }
    /// The latest row and those that a step may reach back to.
    int64_t depth() const { return depth_; }

  private:
    void measure(const float* row, const RowRange& columns);
    void find_totals(const RowRange& columns, const TableStart& start);
    const double* ring_row(int64_t row) const;
    void begin(const RowRange& columns, const TableStart& start, double* totals);
    void come_by(size_t step, const RowRange& columns, double* totals);
    void come_within(const RowRange& columns, double* totals);

    int64_t columns_, dimension_ = 0;
    double radius_;
    std::vector<TableStep> steps_;
    int64_t depth_ = 1, margin_ = 0;
    int64_t rows_ = 0;
    std::vector<double> blocks_;  ///< the sequence, 8 rows at a time with their lanes side by side
    std::vector<double> distances_;
    std::vector<uint8_t> choices_;
    std::vector<double>
        ring_;  ///< `depth_` rows, each after `margin_` columns that no path reaches
};

}  // namespace kinetome
