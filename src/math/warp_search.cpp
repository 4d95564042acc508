#include "kinetome/math/warp_search.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "warp_front.h"

namespace kinetome {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Boxes hold poses of a quarter of a second: wider ones bound little, narrower ones cost more.
constexpr int64_t rows_of_a_box = 8;

/// Boxes are measured in float, whose rounding must not raise a bound.
constexpr double bound_slack = 1 - 1e-5;

void check(const MatrixFView& rows, std::span<const RowRange> sequences,
           std::span<const WarpStep> steps) {
    for (const RowRange& range : sequences) {
        if (range.first < 0 || range.size() <= 0 || range.end > rows.rows()) {
            throw std::invalid_argument("a sequence to search is empty or not among the rows");
        }
        if (!rows.middleRows(range.first, range.size()).allFinite()) {
            throw std::invalid_argument("a sequence to search holds a value that is not finite");
        }
    }
    const auto stands_still = [](const WarpStep& step) {
        return step.first <= 0 || step.second < 0;
    };
    if (steps.empty() || std::ranges::any_of(steps, stands_still)) {
        throw std::invalid_argument("each step of a match must go on in the query");
    }
}

}  // namespace

WarpSearch::WarpSearch(const MatrixFView& rows, std::span<const RowRange> sequences,
                       std::vector<WarpStep> steps)
    : steps_(std::move(steps)) {
    check(rows, sequences, steps_);
    int64_t frames = 0, boxes = 0;
    for (const RowRange& range : sequences) {
        const int64_t own = (range.size() + rows_of_a_box - 1) / rows_of_a_box;
        sequences_.push_back({frames, frames + range.size()});
        boxes_.push_back({boxes, boxes + own});
        frames += range.size();
        boxes += own;
    }
    rows_.resize(frames, rows.cols());
    lows_.resize(boxes, rows.cols());
    highs_.resize(boxes, rows.cols());
    for (size_t s = 0; s < sequences.size(); ++s) {
        const RowRange& range = sequences_[s];
        rows_.middleRows(range.first, range.size()) =
            rows.middleRows(sequences[s].first, range.size());
        for (int64_t box = boxes_[s].first, row = range.first; box < boxes_[s].end; ++box) {
            const auto own = rows_.middleRows(row, std::min(rows_of_a_box, range.end - row));
            lows_.row(box) = own.colwise().minCoeff();
            highs_.row(box) = own.colwise().maxCoeff();
            row += rows_of_a_box;
        }
    }
}

WarpQuery WarpSearch::query(const MatrixFView& rows) const {
    if (rows.rows() == 0) throw std::invalid_argument("a query without rows matches nothing");
    if (!rows_.rows() || rows.cols() != rows_.cols()) {
        throw std::invalid_argument("a query must have the columns of the sequences");
    }
    if (!rows.allFinite()) {
        throw std::invalid_argument("a query holds a value that is not finite");
    }
    return {*this, rows};
}

WarpQuery::WarpQuery(const WarpSearch& search, const MatrixFView& rows)
    : search_(search), rows_(rows), remaining_(search.sequences(), rows.rows()) {
    for (const WarpStep& step : search.steps_) reach_ = std::max<int64_t>(reach_, step.first);
    for (int64_t s = 0; s < search.sequences(); ++s) {
        const std::vector<double> least = least_distances(s);
        bound_what_remains(least, remaining_.row(s).data());
        bounds_.push_back((least[0] + remaining_(s, 0)) / double(rows.rows()));
    }
}

/// Of each row to the boxes of the sequence.
std::vector<double> WarpQuery::least_distances(int64_t sequence) const {
    const RowRange& boxes = search_.boxes_[static_cast<size_t>(sequence)];
    std::vector<double> least;
    for (int64_t i = 0; i < rows_.rows(); ++i) {
        float squared = std::numeric_limits<float>::infinity();
        for (int64_t box = boxes.first; box < boxes.end; ++box) {
            const float own = (search_.lows_.row(box) - rows_.row(i))
                                  .cwiseMax(rows_.row(i) - search_.highs_.row(box))
                                  .cwiseMax(0.0F)
                                  .squaredNorm();
            squared = std::min(squared, own);
        }
        least.push_back(bound_slack * std::sqrt(double(squared)));
    }
    return least;
}

/// A step over several rows counts the one it comes to so many times, and those in between not.
void WarpQuery::bound_what_remains(std::span<const double> least, double* remaining) const {
    const auto rows = static_cast<int64_t>(least.size());
    for (int64_t i = rows - 1; i >= 0; --i) {
        remaining[i] = i + 1 == rows ? 0 : infinite;
        for (const WarpStep& step : search_.steps_) {
            const int64_t to = i + step.first;
            if (to >= rows) continue;
            const double cost = double(step.first) * least[static_cast<size_t>(to)];
            remaining[i] = std::min(remaining[i], cost + remaining[to]);
        }
    }
}

double WarpQuery::cost(int64_t sequence, double at_most) const {
    if (bound(sequence) > at_most) return infinite;
    std::vector<TableStep> steps;
    for (const WarpStep& step : search_.steps_) {
        steps.push_back({step.first, step.second, double(step.first)});
    }
    const MatrixFView columns = search_.rows_of(sequence);
    WarpFront front(columns, std::move(steps), infinite, false);
    // A little more than the bound, so that rounding never gives up what the division would let in.
    const double hopeless = at_most * double(rows_.rows()) * (1 + 1e-12);
    std::vector<double> totals;  // of paths that come through a row, at least
    double least = infinite;
    for (int64_t i = 0; i < rows_.rows(); ++i) {
        const int64_t begins = i == 0 ? columns.rows() : 0;
        front.advance(rows_.row(i).data(), {0, columns.rows()}, {begins, 1.0});
        least = std::ranges::min(front.totals());
        totals.push_back(least + remaining_(sequence, i));
        const auto latest = std::min<size_t>(totals.size(), static_cast<size_t>(reach_));
        if (std::ranges::min(std::span(totals).last(latest)) > hopeless) return infinite;
    }
    const double mean = least / double(rows_.rows());
    return mean <= at_most ? mean : infinite;
}

}  // namespace kinetome
