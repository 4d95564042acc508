#include "kinetome/math/moments.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "kinetome/base/piece_sum.h"

namespace kinetome {
namespace {

// The upper triangle of the scatter takes this many rows at a time, so that each of its entries is
// loaded and stored once for all of them.
constexpr int64_t rows_at_once = 4;

VectorD mean_of(const MatrixFView& rows) {
    VectorD sum = VectorD::Zero(rows.cols());
    for (int64_t i = 0; i < rows.rows(); ++i) {
        for (int64_t j = 0; j < rows.cols(); ++j) sum[j] += double(rows(i, j));
    }
    return sum / static_cast<double>(rows.rows());
}

void add_outer_products(const std::array<std::vector<double>, rows_at_once>& centred,
                        MatrixD& upper) {
    const int64_t dimension = upper.rows();
    const double* const a = centred[0].data();
    const double* const b = centred[1].data();
    const double* const c = centred[2].data();
    const double* const d = centred[3].data();
    for (int64_t i = 0; i < dimension; ++i) {
        double* const row = &upper(i, 0);
        for (int64_t j = i; j < dimension; ++j) {
            row[j] += (a[i] * a[j] + b[i] * b[j]) + (c[i] * c[j] + d[i] * d[j]);
        }
    }
}

MatrixD scatter_about(const VectorD& mean, const MatrixFView& rows) {
    const int64_t dimension = rows.cols();
    MatrixD scatter = MatrixD::Zero(dimension, dimension);
    std::array<std::vector<double>, rows_at_once> centred;
    for (auto& row : centred) row.resize(static_cast<size_t>(dimension));
    for (int64_t first = 0; first < rows.rows(); first += rows_at_once) {
        for (int64_t r = 0; r < rows_at_once; ++r) {
            auto& row = centred[static_cast<size_t>(r)];
            const bool padding = first + r >= rows.rows();
            for (int64_t j = 0; j < dimension; ++j) {
                row[static_cast<size_t>(j)] = padding ? 0.0 : double(rows(first + r, j)) - mean[j];
            }
        }
        add_outer_products(centred, scatter);
    }
    for (int64_t i = 0; i < dimension; ++i) {
        for (int64_t j = 0; j < i; ++j) scatter(i, j) = scatter(j, i);
    }
    return scatter;
}

}  // namespace

Moments moments_of(const MatrixFView& rows) {
    if (rows.rows() == 0) {
        return {0, VectorD::Zero(rows.cols()), MatrixD::Zero(rows.cols(), rows.cols())};
    }
    // The mean first: a scatter about it needs no difference of large numbers.
    Moments moments{rows.rows(), mean_of(rows), {}};
    moments.scatter = scatter_about(moments.mean, rows);
    return moments;
}

void merge(Moments& left, const Moments& right) {
    if (right.count == 0) return;
    if (left.count == 0) {
        left = right;
        return;
    }
    if (left.dimension() != right.dimension()) {
        throw std::invalid_argument("moments of " + std::to_string(left.dimension()) + " and " +
                                    std::to_string(right.dimension()) + " columns cannot be added");
    }
    const auto left_count = static_cast<double>(left.count);
    const auto right_count = static_cast<double>(right.count);
    const double count = left_count + right_count;
    const VectorD difference = right.mean - left.mean;
    const double factor = left_count * right_count / count;
    for (int64_t i = 0; i < left.dimension(); ++i) {
        for (int64_t j = 0; j < left.dimension(); ++j) {
            left.scatter(i, j) += right.scatter(i, j) + (difference[i] * difference[j]) * factor;
        }
    }
    left.mean += difference * (right_count / count);
    left.count += right.count;
}

Moments moments_of(const RowSource& rows, const Workers& workers) {
    auto moments = sum_pieces<Moments>(
        workers, rows.layout(),
        [&](const RowRange& piece) { return moments_of(rows.read(piece).view()); },
        [](Moments& left, const Moments& right) { merge(left, right); });
    return moments ? *std::move(moments) : moments_of(MatrixF(0, rows.columns()));
}

void pack(Packer& out, const Moments& moments) {
    out.put(moments.count);
    pack(out, moments.mean);
    pack(out, moments.scatter);
}

void unpack(Unpacker& in, Moments& moments) {
    moments.count = in.get<int64_t>();
    unpack(in, moments.mean);
    unpack(in, moments.scatter);
}

}  // namespace kinetome
