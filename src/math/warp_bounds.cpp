#include "warp_bounds.h"

#include <algorithm>
#include <limits>

#include "kinetome/math/moments.h"
#include "kinetome/math/symmetric_eigen.h"

namespace kinetome {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

/// Directions. Poses are correlated: these hold nearly all of what tells them apart.
constexpr int64_t most_axes = 16;

constexpr double float_rounding = 0x1p-23;

}  // namespace

WarpBounds::WarpBounds(const MatrixF& rows, std::span<const RowRange> sequences,
                       std::span<const WarpStep> steps)
    : steps_(steps.begin(), steps.end()) {
    const Moments moments = moments_of(rows);
    mean_ = moments.mean;
    axes_ = symmetric_eigen(moments.scatter).vectors.leftCols(std::min(rows.cols(), most_axes));

    int64_t gap = 0;
    for (const WarpStep& step : steps_) gap = std::max<int64_t>(gap, step.second);
    for (const RowRange& sequence : sequences) {
        width_ += gap;
        columns_.push_back({width_, width_ + sequence.size()});
        width_ += sequence.size();
    }
    width_ = (width_ + lane_count - 1) / lane_count * lane_count;
    gaps_.setConstant(width_, infinite);
    along_axes_.resize(static_cast<size_t>(axes_.cols() * width_));
    const MatrixF own = projected(rows);
    largest_ = own.cwiseAbs().maxCoeff();
    for (size_t s = 0; s < sequences.size(); ++s) {
        const RowRange& columns = columns_[s];
        gaps_.segment(columns.first, columns.size()).setZero();
        for (int64_t axis = 0; axis < axes_.cols(); ++axis) {
            Eigen::Map<VectorF>(along_axes_.data() + axis * width_ + columns.first,
                                columns.size()) =
                own.col(axis).segment(sequences[s].first, columns.size());
        }
    }
}

MatrixF WarpBounds::projected(const MatrixF& rows) const {
    return ((rows.cast<double>().rowwise() - mean_.transpose()) * axes_).cast<float>();
}

void WarpBounds::measure(const float* row, float* distances) const {
    for (int64_t column = 0; column < width_; column += lane_count) {
        Lanes squares = {};
        for (int64_t axis = 0; axis < axes_.cols(); ++axis) {
            const Lanes difference =
                load_lanes(along_axes_.data() + axis * width_ + column) - row[axis];
            squares += difference * difference;
        }
        store_lanes(squares, distances + column);
    }
}

std::vector<double> WarpBounds::of(const MatrixF& query) const {
    const MatrixF rows = projected(query);
    int64_t depth = 1, margin = 0;
    for (const WarpStep& step : steps_) {
        depth = std::max<int64_t>(depth, step.first + 1);
        margin = std::max<int64_t>(margin, step.second);
    }
    std::vector<Eigen::ArrayXf> latest(static_cast<size_t>(depth),
                                       Eigen::ArrayXf::Constant(margin + width_, infinite));
    Eigen::ArrayXf distances(width_);
    for (int64_t i = 0; i < rows.rows(); ++i) {
        measure(rows.row(i).data(), distances.data());
        distances = distances.sqrt() + gaps_;
        auto totals = latest[static_cast<size_t>(i % depth)].tail(width_);
        if (i == 0) {
            totals = distances;
            continue;
        }
        totals.setConstant(infinite);
        for (const WarpStep& step : steps_) {
            if (step.first > i) continue;
            const auto& from = latest[static_cast<size_t>((i - step.first) % depth)];
            totals = totals.min(from.segment(margin - step.second, width_) +
                                static_cast<float>(step.first) * distances);
        }
    }
    const auto ends = latest[static_cast<size_t>((rows.rows() - 1) % depth)].tail(width_);
    std::vector<double> bounds;
    for (const RowRange& columns : columns_) {
        bounds.push_back(lowered(ends.segment(columns.first, columns.size()).minCoeff(), rows));
    }
    return bounds;
}

double WarpBounds::lowered(float total, const MatrixF& query) const {
    // Coordinates are rounded in proportion to themselves, sums to what is added up.
    const auto terms = double(query.rows() + axes_.cols() + 8);
    const double relative = 2 * float_rounding * terms;
    const double coordinates = double(largest_ + query.cwiseAbs().maxCoeff());
    const double absolute = 4 * float_rounding * std::sqrt(double(axes_.cols())) * coordinates;
    return std::max(0.0, double(total) / double(query.rows()) * (1 - relative) - absolute);
}

}  // namespace kinetome
