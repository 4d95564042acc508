// A partition's pose vectors in the space of its principal components, read and projected when they
// are asked for; pieces stay in memory as far as the budget allows.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/stop.h"
#include "kinetome/math/pca.h"
#include "kinetome/math/row_source.h"
#include "kinetome/stages/pose_rows.h"

namespace kinetome {

/// n × D. Reading throws Interrupted when a stop was asked for.
class ProjectedRows final : public RowSource {
  public:
    /// Keeps pieces of this rank's share, `kept_bytes` at most. Refers to partition and components.
    ProjectedRows(const PosePartition& partition, const Pca& pca, const Workers& workers,
                  uint64_t kept_bytes, StopToken stop);

    int64_t columns() const override { return pca_.dimension(); }
    const PieceLayout& layout() const override { return partition_.layout; }
    RowBlock read(const RowRange& range) const override;

    /// Rows that stay in memory once read.
    int64_t kept_rows() const { return kept_rows_; }

  private:
    struct KeptPiece {
        bool keep = false;
        std::once_flag once;
        std::shared_ptr<const MatrixF> rows;
    };

    MatrixF project(const RowRange& range) const;
    std::shared_ptr<const MatrixF> kept(int64_t piece) const;

    const PosePartition& partition_;
    const Pca& pca_;
    StopToken stop_;
    int64_t kept_rows_ = 0;
    mutable std::vector<KeptPiece> kept_;  ///< one for each piece of the layout
};

}  // namespace kinetome
