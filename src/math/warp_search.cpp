#include "kinetome/math/warp_search.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "warp_bounds.h"
#include "warp_front.h"

namespace kinetome {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

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
    int64_t frames = 0;
    for (const RowRange& range : sequences) {
        sequences_.push_back({frames, frames + range.size()});
        frames += range.size();
    }
    rows_.resize(frames, rows.cols());
    for (size_t s = 0; s < sequences.size(); ++s) {
        rows_.middleRows(sequences_[s].first, sequences_[s].size()) =
            rows.middleRows(sequences[s].first, sequences[s].size());
    }
    if (frames > 0) bounds_ = std::make_unique<const WarpBounds>(rows_, sequences_, steps_);
}

WarpSearch::~WarpSearch() = default;
WarpSearch::WarpSearch(WarpSearch&&) noexcept = default;
WarpSearch& WarpSearch::operator=(WarpSearch&&) noexcept = default;

WarpQuery WarpSearch::query(const MatrixFView& rows) const {
    if (rows.rows() == 0) throw std::invalid_argument("a query without rows matches nothing");
    if (!bounds_ || rows.cols() != rows_.cols()) {
        throw std::invalid_argument("a query must have the columns of the sequences");
    }
    if (!rows.allFinite()) {
        throw std::invalid_argument("a query holds a value that is not finite");
    }
    return {*this, rows};
}

WarpQuery::WarpQuery(const WarpSearch& search, const MatrixFView& rows)
    : search_(search), rows_(rows), bounds_(search.bounds_->of(rows_)) {}

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
    std::vector<double> least;  // total of each row; a path comes through one of those within reach
    for (int64_t i = 0; i < rows_.rows(); ++i) {
        const int64_t begins = i == 0 ? columns.rows() : 0;
        front.advance(rows_.row(i).data(), {0, columns.rows()}, {begins, 1.0});
        least.push_back(std::ranges::min(front.totals()));
        const auto reach = std::min<size_t>(least.size(), static_cast<size_t>(front.depth() - 1));
        if (std::ranges::min(std::span(least).last(reach)) > hopeless) return infinite;
    }
    const double mean = least.back() / double(rows_.rows());
    return mean <= at_most ? mean : infinite;
}

}  // namespace kinetome
