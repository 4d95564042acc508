#include "frame_super.h"

#include <algorithm>
#include <cmath>

#include "mixture_input.h"

namespace kinetome {

static_assert(super_rows % strip_rows == 0 && strip_rows % tile_rows == 0);

FrameSuper::FrameSuper(int64_t dimension)
    : dimension_(dimension),
      centre_(static_cast<size_t>(dimension)),
      largest_(static_cast<size_t>(super_rows / strip_rows)),
      strips_(static_cast<size_t>(super_rows * (dimension + 1))),
      rows_(static_cast<size_t>(super_rows * padded(dimension))) {}

void FrameSuper::load(const MatrixFView& rows, const RowRange& range, int64_t first_row) {
    size_ = range.size();
    find_centre(rows, range, first_row);
    for (int64_t i = 0; i < size_; ++i) {
        const float* const from = rows.data() + (range.first + i) * rows.outerStride();
        float* const to = rows_.data() + i * row_stride();
        for (int64_t j = 0; j < dimension_; ++j) to[j] = from[j] - centre_[size_t(j)];
    }
    std::fill(largest_.begin(), largest_.end(), 0.0F);
    for (int64_t i = 0; i < strips() * strip_rows; ++i) spread(i);
}

void FrameSuper::find_centre(const MatrixFView& rows, const RowRange& range, int64_t first_row) {
    std::vector<double> sums(static_cast<size_t>(dimension_));
    for (int64_t i = range.first; i < range.end; ++i) {
        const float* const row = rows.data() + i * rows.outerStride();
        for (size_t j = 0; j < sums.size(); ++j) sums[j] += double(row[j]);
    }
    // A sum of finite floats is a finite double: one look at the sum tells of every value.
    for (size_t j = 0; j < sums.size(); ++j) {
        if (!std::isfinite(sums[j])) require_finite(rows, first_row);
        centre_[j] = static_cast<float>(sums[j] / static_cast<double>(range.size()));
    }
}

void FrameSuper::spread(int64_t index) {
    const float* const values = row(std::min(index, size_ - 1));
    const int64_t strip_index = index / strip_rows;
    float* const lane =
        strips_.data() + strip_index * (dimension_ + 1) * strip_rows + index % strip_rows;
    float square = 0;
    for (int64_t j = 0; j < dimension_; ++j) {
        lane[j * strip_rows] = values[j];
        square += values[j] * values[j];
    }
    lane[dimension_ * strip_rows] = square;
    float& largest = largest_[static_cast<size_t>(strip_index)];
    largest = std::max(largest, square);
}

}  // namespace kinetome
