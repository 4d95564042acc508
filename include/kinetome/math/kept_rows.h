// Rows that stay in memory once read, as far as a budget allows.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/math/row_source.h"

namespace kinetome {

/// n × d rows that a function makes.
class KeptRows final : public RowSource {
  public:
    /// Rows of a range; called on several threads. A value must not depend on the range.
    using Make = std::function<MatrixF(const RowRange&)>;

    /// Keeps pieces of this rank's share, the first in its order, `kept_bytes` at most. Refers to
    /// the layout.
    KeptRows(const PieceLayout& layout, int64_t columns, Make make, const Workers& workers,
             uint64_t kept_bytes);

    int64_t columns() const override { return columns_; }
    const PieceLayout& layout() const override { return layout_; }
    RowBlock read(const RowRange& range) const override;

    /// Rows that stay in memory once read.
    int64_t kept_rows() const { return kept_rows_; }

  private:
    struct KeptPiece {
        bool keep = false;
        std::once_flag once;
        std::shared_ptr<const MatrixF> rows;
    };

    std::shared_ptr<const MatrixF> kept(int64_t piece) const;

    const PieceLayout& layout_;
    int64_t columns_;
    Make make_;
    int64_t kept_rows_ = 0;
    mutable std::vector<KeptPiece> kept_;  ///< one for each piece of the layout
};

}  // namespace kinetome
