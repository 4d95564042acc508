#include "kinetome/math/assignment.h"

#include <limits>
#include <stdexcept>

namespace kinetome {
namespace {

/// Rows join one by one, each along a shortest augmenting path in reduced costs; n ≤ m.
/// Row and column 0 are the path's source: a column of row 0 is free.
class HungarianMethod {
  public:
    explicit HungarianMethod(const MatrixD& costs)
        : costs_(costs),
          row_potential_(VectorD::Zero(costs.rows() + 1)),
          column_potential_(VectorD::Zero(costs.cols() + 1)),
          row_of_column_(static_cast<size_t>(costs.cols()) + 1, 0) {
        for (int64_t row = 1; row <= costs.rows(); ++row) assign(row);
    }

    std::vector<int32_t> columns_of_rows() const {
        std::vector<int32_t> columns(static_cast<size_t>(costs_.rows()), -1);
        for (size_t column = 1; column < row_of_column_.size(); ++column) {
            const int64_t row = row_of_column_[column];
            if (row > 0) columns[static_cast<size_t>(row - 1)] = static_cast<int32_t>(column - 1);
        }
        return columns;
    }

  private:
    int64_t& row_of(int64_t column) { return row_of_column_[static_cast<size_t>(column)]; }

    double reduced_cost(int64_t row, int64_t column) const {
        return costs_(row - 1, column - 1) - row_potential_[row] - column_potential_[column];
    }

    void assign(int64_t new_row) {
        const auto columns = static_cast<size_t>(costs_.cols()) + 1;
        VectorD least = VectorD::Constant(costs_.cols() + 1, infinity);
        std::vector<int64_t> reached_from(columns, 0);
        std::vector<char> reached(columns, false);
        row_of(0) = new_row;
        int64_t column = 0;
        while (row_of(column) != 0) {
            reached[static_cast<size_t>(column)] = true;
            const int64_t row = row_of(column);
            double step = infinity;
            int64_t next = 0;
            for (int64_t j = 1; j <= costs_.cols(); ++j) {
                if (reached[static_cast<size_t>(j)]) continue;
                const double cost = reduced_cost(row, j);
                if (cost < least[j]) {
                    least[j] = cost;
                    reached_from[static_cast<size_t>(j)] = column;
                }
                if (least[j] < step) {
                    step = least[j];
                    next = j;
                }
            }
            shift_potentials(step, reached, least);
            column = next;
        }
        while (column != 0) {
            const int64_t before = reached_from[static_cast<size_t>(column)];
            row_of(column) = row_of(before);
            column = before;
        }
    }

    void shift_potentials(double step, const std::vector<char>& reached, VectorD& least) {
        for (int64_t j = 0; j <= costs_.cols(); ++j) {
            if (reached[static_cast<size_t>(j)]) {
                row_potential_[row_of(j)] += step;
                column_potential_[j] -= step;
            } else {
                least[j] -= step;
            }
        }
    }

    static constexpr double infinity = std::numeric_limits<double>::infinity();
    const MatrixD& costs_;
    VectorD row_potential_, column_potential_;
    std::vector<int64_t> row_of_column_;
};

}  // namespace

std::vector<int32_t> best_assignment(const MatrixDView& values) {
    if (!values.allFinite()) {
        throw std::invalid_argument("an assignment needs values that are finite");
    }
    if (values.rows() <= values.cols()) {
        const MatrixD costs = -values;
        return HungarianMethod(costs).columns_of_rows();
    }
    const MatrixD costs = -values.transpose();
    const std::vector<int32_t> rows_of_columns = HungarianMethod(costs).columns_of_rows();
    std::vector<int32_t> columns(static_cast<size_t>(values.rows()), -1);
    for (size_t j = 0; j < rows_of_columns.size(); ++j) {
        columns[static_cast<size_t>(rows_of_columns[j])] = static_cast<int32_t>(j);
    }
    return columns;
}

}  // namespace kinetome
