#include "mixture_input.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace kinetome {

void require_finite(const MatrixFView& rows) {
    for (int64_t i = 0; i < rows.rows(); ++i) {
        for (int64_t j = 0; j < rows.cols(); ++j) {
            if (!std::isfinite(rows(i, j))) {
                throw std::invalid_argument("row " + std::to_string(i) + ", column " +
                                            std::to_string(j) +
                                            " holds a value that is not finite");
            }
        }
    }
}

void require_layout_of(const MatrixFView& rows, const PieceLayout& layout) {
    if (layout.rows() != rows.rows()) {
        throw std::invalid_argument("a layout of " + std::to_string(layout.rows()) +
                                    " rows was given for a matrix of " +
                                    std::to_string(rows.rows()));
    }
}

void require_dimension_of(const MatrixFView& rows, int64_t dimension) {
    if (rows.cols() != dimension || dimension == 0) {
        throw std::invalid_argument("rows of " + std::to_string(rows.cols()) +
                                    " columns were given to a mixture in " +
                                    std::to_string(dimension) + " dimensions");
    }
}

}  // namespace kinetome
