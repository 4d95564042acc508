#include "primitive_rows.h"

#include <stdexcept>
#include <string>

namespace kinetome {

void require_rows(const MatrixFView& features, std::span<const CorpusPrimitive> primitives) {
    for (const CorpusPrimitive& primitive : primitives) {
        const RowRange& rows = primitive.rows;
        const std::string name = "the primitive in rows [" + std::to_string(rows.first) + ", " +
                                 std::to_string(rows.end) + ")";
        if (rows.first < 0 || rows.size() <= 0 || rows.end > features.rows()) {
            throw std::invalid_argument(name + " is empty or lies outside the features");
        }
        if (!rows_of(features, primitive).allFinite()) {
            throw std::invalid_argument(name + " holds a value that is not finite");
        }
    }
}

}  // namespace kinetome
