#include <algorithm>
#include <limits>
#include <numeric>

#include "signature_ends.h"

namespace kinetome {
namespace {

constexpr float unreachable = std::numeric_limits<float>::infinity();

/// One row of the table, with room for steps that come from before its first column.
struct TableRow {
    static constexpr int64_t margin = 2;
    std::vector<float> totals;
    std::vector<int32_t> begins;  ///< column in which the path to each cell begins

    explicit TableRow(int64_t columns)
        : totals(static_cast<size_t>(margin + columns), unreachable),
          begins(static_cast<size_t>(margin + columns), 0) {}
    float* total() { return totals.data() + margin; }
    int32_t* begin() { return begins.data() + margin; }
};

/// Comes to all cells of a row from those `columns` before them in an earlier row.
void come_by(TableRow& from, int64_t columns, float weight, const float* distances, TableRow& to,
             int64_t count) {
    const float* const __restrict source = from.total() - columns;
    const int32_t* const __restrict source_begin = from.begin() - columns;
    float* const __restrict total = to.total();
    int32_t* const __restrict begin = to.begin();
    for (int64_t j = 0; j < count; ++j) {
        const float candidate = source[j] + weight * distances[j];
        const bool nearer = candidate < total[j];
        total[j] = nearer ? candidate : total[j];
        begin[j] = nearer ? source_begin[j] : begin[j];
    }
}

/// The table of moments of the query and of the text, row after row.
class PacedTable {
  public:
    explicit PacedTable(int64_t columns) : columns_(columns), rows_(3, TableRow(columns)) {}

    void advance(const float* distances) {
        TableRow& row = row_before(0);
        std::fill_n(row.total(), columns_, unreachable);
        if (row_ == 0) {
            std::copy_n(distances, columns_, row.total());
            std::iota(row.begin(), row.begin() + columns_, 0);
        } else {
            come_by(row_before(1), 1, 1, distances, row, columns_);
            come_by(row_before(1), 2, 1, distances, row, columns_);
            if (row_ > 1) come_by(row_before(2), 1, 2, distances, row, columns_);
        }
        ++row_;
    }

    /// Of the latest row.
    TableRow& latest() { return row_before(1); }

  private:
    TableRow& row_before(int64_t rows) { return rows_[static_cast<size_t>((row_ + 3 - rows) % 3)]; }

    int64_t columns_;
    std::vector<TableRow> rows_;
    int64_t row_ = 0;
};

}  // namespace

std::vector<SignatureMatch> paced_ends(const MatrixFView& distances, int32_t step) {
    PacedTable table(distances.cols());
    for (Eigen::Index i = 0; i < distances.rows(); ++i) {
        table.advance(distances.data() + i * distances.outerStride());
    }
    std::vector<SignatureMatch> ends;
    for (int64_t j = 0; j < distances.cols(); ++j) {
        const float total = table.latest().total()[j];
        if (total == unreachable) continue;
        ends.push_back({{int64_t{table.latest().begin()[j]} * step, (j + 1) * step},
                        double(total) / double(distances.rows())});
    }
    return ends;
}

}  // namespace kinetome
