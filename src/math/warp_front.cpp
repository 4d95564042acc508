#include "warp_front.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kinetome {
namespace {

constexpr int64_t lanes = 8;
constexpr double unreachable = std::numeric_limits<double>::infinity();

}  // namespace

WarpFront::WarpFront(int64_t columns, std::vector<TableStep> steps, double radius,
                     bool with_choices)
    : columns_(columns), radius_(radius), steps_(std::move(steps)) {
    for (const TableStep& step : steps_) {
        depth_ = std::max<int64_t>(depth_, step.rows + 1);
        margin_ = std::max<int64_t>(margin_, step.columns);
    }
    distances_.resize(static_cast<size_t>((columns_ + lanes - 1) / lanes * lanes));
    if (with_choices) choices_.resize(static_cast<size_t>(columns_));
    ring_.assign(static_cast<size_t>(depth_ * (margin_ + columns_)), unreachable);
}

WarpFront::WarpFront(const MatrixFView& sequence, std::vector<TableStep> steps, double radius,
                     bool with_choices)
    : WarpFront(sequence.rows(), std::move(steps), radius, with_choices) {
    dimension_ = sequence.cols();
    blocks_.resize(distances_.size() * static_cast<size_t>(dimension_));
    for (int64_t j = 0; j < columns_; ++j) {
        double* const block = blocks_.data() + j / lanes * dimension_ * lanes + j % lanes;
        for (int64_t c = 0; c < dimension_; ++c) block[c * lanes] = double(sequence(j, c));
    }
}

void WarpFront::measure(const float* row, const RowRange& columns) {
    const double squared_radius = radius_ * radius_;
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
        // All roots at once: std::sqrt, which may set errno, is called lane by lane.
        double* const distances = distances_.data() + first;
        using Roots = Eigen::Array<double, lanes, 1>;
        Eigen::Map<Roots>{distances} = Eigen::Map<const Roots>(squares).sqrt();
        for (int64_t lane = 0; lane < lanes; ++lane) {
            distances[lane] = squares[lane] <= squared_radius ? distances[lane] : unreachable;
        }
    }
}

const double* WarpFront::ring_row(int64_t row) const {
    // Rows before the first are there as well: none has been reached.
    return ring_.data() + (row + depth_) % depth_ * (margin_ + columns_) + margin_;
}

void WarpFront::begin(const RowRange& columns, const TableStart& start, double* totals) {
    std::fill_n(totals, columns_, unreachable);
    std::ranges::fill(choices_, begins_here);
    for (int64_t j = columns.first; j < std::min(columns.end, start.columns); ++j) {
        const double weight = start.weight + double(j) * start.per_column;
        const double total = weight * distances_[static_cast<size_t>(j)];
        if (total < unreachable) totals[j] = total;
    }
}

void WarpFront::come_by(size_t step, const RowRange& columns, double* totals) {
    const double weight = steps_[step].weight;
    const double* const from = ring_row(rows_ - steps_[step].rows) - steps_[step].columns;
    const double* const distances = distances_.data();
    if (choices_.empty()) {
        for (int64_t j = columns.first; j < columns.end; ++j) {
            const double total = from[j] + weight * distances[j];
            totals[j] = total < totals[j] ? total : totals[j];
        }
        return;
    }
    const auto choice = static_cast<uint8_t>(step + 1);
    for (int64_t j = columns.first; j < columns.end; ++j) {
        const double total = from[j] + weight * distances[j];
        uint8_t& chosen = choices_[static_cast<size_t>(j)];
        if (total < totals[j] || (total == totals[j] && choice < chosen)) {
            totals[j] = total;
            chosen = choice;
        }
    }
}

void WarpFront::come_within(const RowRange& columns, double* totals) {
    if (std::ranges::none_of(steps_, [](const TableStep& step) { return step.rows == 0; })) return;
    for (int64_t j = columns.first; j < columns.end; ++j) {
        for (size_t s = 0; s < steps_.size(); ++s) {
            if (steps_[s].rows == 0) come_by(s, {j, j + 1}, totals);
        }
    }
}

void WarpFront::advance(const float* row, const RowRange& columns, const TableStart& start) {
    measure(row, columns);
    find_totals(columns, start);
}

void WarpFront::advance(const double* distances, const RowRange& columns, const TableStart& start) {
    for (int64_t j = columns.first; j < columns.end; ++j) {
        distances_[static_cast<size_t>(j)] = distances[j] <= radius_ ? distances[j] : unreachable;
    }
    find_totals(columns, start);
}

void WarpFront::find_totals(const RowRange& columns, const TableStart& start) {
    double* const totals = ring_.data() + (ring_row(rows_) - ring_.data());
    begin(columns, start, totals);
    for (size_t s = 0; s < steps_.size(); ++s) {
        if (steps_[s].rows > 0) come_by(s, columns, totals);
    }
    // Steps within the row come last: what they lead on from must be settled.
    come_within(columns, totals);
    ++rows_;
}

}  // namespace kinetome
