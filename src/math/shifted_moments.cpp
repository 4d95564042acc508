#include "kinetome/math/shifted_moments.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace kinetome {
namespace {

// A tile of the second moment stays in registers while all rows of a batch pass by.
constexpr int64_t tile_rows = 4, tile_columns = 8;
// Rows that are centred together, so that they stay in the first-level cache.
constexpr int64_t batch_rows = 32;

int64_t padded(int64_t dimension) {
    return (dimension + tile_columns - 1) / tile_columns * tile_columns;
}

/// Entries of the packed triangle before row i.
int64_t row_start(int64_t dimension, int64_t i) {
    return i * dimension - i * (i - 1) / 2;
}

using Tile = std::array<std::array<double, tile_columns>, tile_rows>;

Tile tile_of(const double* centred, int64_t count, int64_t stride, int64_t i, int64_t j) {
    Tile tile{};
    for (int64_t r = 0; r < count; ++r) {
        const double* const row = centred + r * stride;
        for (int64_t a = 0; a < tile_rows; ++a) {
            for (int64_t b = 0; b < tile_columns; ++b) {
                tile[static_cast<size_t>(a)][static_cast<size_t>(b)] += row[i + a] * row[j + b];
            }
        }
    }
    return tile;
}

void add_tile(const Tile& tile, int64_t dimension, int64_t i, int64_t j, double* second) {
    for (int64_t a = 0; a < std::min(tile_rows, dimension - i); ++a) {
        double* const row = second + row_start(dimension, i + a) - (i + a);
        for (int64_t b = std::max<int64_t>(i + a - j, 0); b < std::min(tile_columns, dimension - j);
             ++b) {
            row[j + b] += tile[static_cast<size_t>(a)][static_cast<size_t>(b)];
        }
    }
}

}  // namespace

ShiftedMoments shifted_moments(const MatrixFView& rows, std::span<const int32_t> selected,
                               const VectorD& point) {
    const int64_t dimension = rows.cols(), stride = padded(dimension);
    ShiftedMoments moments{
        static_cast<int64_t>(selected.size()), VectorD::Zero(dimension),
        std::vector<double>(static_cast<size_t>(row_start(dimension, dimension)))};
    std::vector<double> centred(static_cast<size_t>(batch_rows * stride));
    for (size_t first = 0; first < selected.size(); first += batch_rows) {
        const int64_t count = std::min<int64_t>(batch_rows, moments.count - int64_t(first));
        for (int64_t r = 0; r < count; ++r) {
            const int64_t from = selected[first + static_cast<size_t>(r)];
            double* const row = centred.data() + r * stride;
            for (int64_t j = 0; j < dimension; ++j) {
                row[j] = double(rows(from, j)) - point[j];
                moments.sum[j] += row[j];
            }
        }
        for (int64_t i = 0; i < dimension; i += tile_rows) {
            for (int64_t j = i / tile_columns * tile_columns; j < dimension; j += tile_columns) {
                add_tile(tile_of(centred.data(), count, stride, i, j), dimension, i, j,
                         moments.second.data());
            }
        }
    }
    return moments;
}

void merge(ShiftedMoments& left, const ShiftedMoments& right) {
    left.count += right.count;
    left.sum += right.sum;
    for (size_t i = 0; i < left.second.size(); ++i) left.second[i] += right.second[i];
}

Moments about_mean(const ShiftedMoments& shifted, const VectorD& point) {
    if (shifted.count == 0) throw std::invalid_argument("there is no mean of no rows");
    const VectorD from_point = shifted.sum / static_cast<double>(shifted.count);
    const int64_t dimension = shifted.sum.size();
    Moments moments{shifted.count, point + from_point, MatrixD(dimension, dimension)};
    const double* at = shifted.second.data();
    for (int64_t i = 0; i < dimension; ++i) {
        for (int64_t j = i; j < dimension; ++j) {
            moments.scatter(i, j) = *at++ - shifted.sum[i] * from_point[j];
            moments.scatter(j, i) = moments.scatter(i, j);
        }
    }
    return moments;
}

int64_t shifted_moment_bytes(int64_t dimension) {
    return static_cast<int64_t>(sizeof(double)) * (dimension + row_start(dimension, dimension));
}

void pack(Packer& out, const ShiftedMoments& moments) {
    out.put(moments.count);
    pack(out, moments.sum);
    pack(out, moments.second);
}

void unpack(Unpacker& in, ShiftedMoments& moments) {
    unpack(in, moments.count);
    unpack(in, moments.sum);
    unpack(in, moments.second);
}

}  // namespace kinetome
