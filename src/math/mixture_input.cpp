#include "mixture_input.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace kinetome {

void require_finite(const MatrixFView& rows, int64_t first_row) {
    for (int64_t i = 0; i < rows.rows(); ++i) {
        for (int64_t j = 0; j < rows.cols(); ++j) {
            if (!std::isfinite(rows(i, j))) {
                throw std::invalid_argument("row " + std::to_string(first_row + i) + ", column " +
                                            std::to_string(j) +
                                            " holds a value that is not finite");
            }
        }
    }
}

void require_finite(const RowSource& rows, const Moments& moments) {
    // Sums of finite floats are finite doubles: the moments tell of every value.
    bool finite = true;
    for (int64_t j = 0; j < moments.dimension(); ++j) {
        finite = finite && std::isfinite(moments.mean[j]) && std::isfinite(moments.scatter(j, j));
    }
    if (finite) return;
    for (const RowRange& piece : rows.layout().pieces) {
        require_finite(rows.read(piece).view(), piece.first);
    }
}

void require_dimension_of(int64_t columns, int64_t dimension) {
    if (columns != dimension || dimension == 0) {
        throw std::invalid_argument("rows of " + std::to_string(columns) +
                                    " columns were given to a mixture in " +
                                    std::to_string(dimension) + " dimensions");
    }
}

}  // namespace kinetome
