#include "warp_front.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kinetome {
namespace {

constexpr int64_t lanes = 8;
constexpr double unreachable = std::numeric_limits<double>::infinity();

}  // namespace

WarpFront::WarpFront(const MatrixFView& sequence, std::vector<TableStep> steps)
    : columns_(sequence.rows()), dimension_(sequence.cols()), steps_(std::move(steps)) {
    for (const TableStep& step : steps_) depth_ = std::max<int64_t>(depth_, step.rows + 1);
    const int64_t block_count = (columns_ + lanes - 1) / lanes;
    blocks_.resize(static_cast<size_t>(block_count * dimension_ * lanes));
    for (int64_t j = 0; j < columns_; ++j) {
        double* const block = blocks_.data() + j / lanes * dimension_ * lanes + j % lanes;
        for (int64_t c = 0; c < dimension_; ++c) block[c * lanes] = double(sequence(j, c));
    }
    distances_.resize(static_cast<size_t>(block_count * lanes));
    ring_.assign(static_cast<size_t>(depth_ * columns_), unreachable);
    choices_.resize(static_cast<size_t>(columns_));
}

void WarpFront::measure(const float* row, const RowRange& columns) {
    for (int64_t first = columns.first / lanes * lanes; first < columns.end; first += lanes) {
        const double* const block = blocks_.data() + first * dimension_;
        double squares[lanes] = {};
        for (int64_t c = 0; c < dimension_; ++c) {
            const double value = double(row[c]);
            for (int64_t lane = 0; lane < lanes; ++lane) {
                const double difference = value - block[c * lanes + lane];
                squares[lane] += difference * difference;
            }
        }
        for (int64_t lane = 0; lane < lanes; ++lane) {
            distances_[static_cast<size_t>(first + lane)] = std::sqrt(squares[lane]);
        }
    }
}

double* WarpFront::ring_row(int64_t row) {
    return ring_.data() + row % depth_ * columns_;
}

std::span<const double> WarpFront::totals(int64_t back) const {
    return {ring_.data() + (rows_ - 1 - back) % depth_ * columns_, static_cast<size_t>(columns_)};
}

void WarpFront::advance(const float* row, const RowRange& columns, const TableStart& start) {
    measure(row, columns);
    double* const totals = ring_row(rows_);
    std::fill_n(totals, columns_, unreachable);
    for (int64_t j = columns.first; j < columns.end; ++j) {
        const double distance = distances_[static_cast<size_t>(j)];
        double least = unreachable;
        uint8_t choice = begins_here;
        if (j < start.columns) {
            const double total = (start.weight + double(j) * start.per_column) * distance;
            if (total < least) least = total;
        }
        for (size_t s = 0; s < steps_.size(); ++s) {
            const TableStep& step = steps_[s];
            if (step.rows > rows_ || step.columns > j) continue;
            const double total =
                ring_row(rows_ - step.rows)[j - step.columns] + step.weight * distance;
            if (total < least) {
                least = total;
                choice = static_cast<uint8_t>(s);
            }
        }
        totals[j] = least;
        choices_[static_cast<size_t>(j)] = choice;
    }
    ++rows_;
}

}  // namespace kinetome
