// Up to 256 consecutive rows laid out for vectors of frames, about their own centre: rows that
// follow each other in motion are near each other, so that products about the centre cancel little.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"
#include "lanes.h"

namespace kinetome {

/// Frames that share a list of candidate clusters.
inline constexpr int64_t tile_rows = 16;
/// Vectors of frames in one pass of the search: with six clusters they fill the registers.
inline constexpr int strip_vectors = lane_count == 16 ? 4 : 2;
inline constexpr int64_t strip_rows = strip_vectors * lane_count;
inline constexpr int64_t super_rows = 256;

class FrameSuper {
  public:
    explicit FrameSuper(int64_t dimension);

    /// Takes rows [range.first, range.end), at most super_rows and at least one. Throws
    /// std::invalid_argument when a value is not finite, counting rows from `first_row`. Lanes
    /// beyond the end repeat the last row.
    void load(const MatrixFView& rows, const RowRange& range, int64_t first_row);

    int64_t size() const { return size_; }
    int64_t dimension() const { return dimension_; }
    int64_t strips() const { return (size_ + strip_rows - 1) / strip_rows; }
    int64_t tiles() const { return (size_ + tile_rows - 1) / tile_rows; }
    std::span<const float> centre() const { return centre_; }

    /// (d + 1) × strip_rows: the values about the centre, dimension by dimension, then |y|².
    const float* strip(int64_t index) const {
        return strips_.data() + index * (dimension_ + 1) * strip_rows;
    }
    /// The 16 frames of a tile inside its strip; strip_rows apart from dimension to dimension.
    const float* tile(int64_t index) const {
        const int64_t first = index * tile_rows;
        return strip(first / strip_rows) + first % strip_rows;
    }
    /// Largest |y|² in the strip.
    float largest_square(int64_t strip) const { return largest_[static_cast<size_t>(strip)]; }

    /// One row about the centre, padded with zeros to row_stride() values.
    const float* row(int64_t index) const { return rows_.data() + index * row_stride(); }
    int64_t row_stride() const { return padded(dimension_); }
    static int64_t padded(int64_t dimension) {
        return (dimension + lane_count - 1) / lane_count * lane_count;
    }

  private:
    void find_centre(const MatrixFView& rows, const RowRange& range, int64_t first_row);
    void spread(int64_t row);

    int64_t dimension_;
    int64_t size_ = 0;
    std::vector<float> centre_;
    std::vector<float> largest_;
    LaneBuffer strips_;
    LaneBuffer rows_;
};

}  // namespace kinetome
