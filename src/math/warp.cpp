#include "kinetome/math/warp.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "warp_front.h"
#include "warp_region.h"

namespace kinetome {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

void check_columns(const MatrixFView& first, const MatrixFView& second) {
    if (first.cols() == second.cols()) return;
    throw std::invalid_argument("rows of " + std::to_string(first.cols()) + " and of " +
                                std::to_string(second.cols()) + " columns cannot be warped");
}

void check(std::span<const WarpStep> steps) {
    for (const WarpStep& step : steps) {
        if (step.first < 0 || step.second < 0 || step == WarpStep{0, 0}) {
            throw std::invalid_argument("a warping step must lead on");
        }
    }
    if (steps.empty() || steps.size() > std::numeric_limits<uint8_t>::max() - 1) {
        throw std::invalid_argument("warping takes 1 to 254 steps");
    }
}

/// What rows that a path goes on by, or that it leaves out at an end, weigh.
double weight_of(WarpWeight weight, int64_t first, int64_t second) {
    if (weight == WarpWeight::both) return double(first + second);
    return double(first);
}

double cell_weight(WarpWeight weight, int64_t first, int64_t second) {
    return weight == WarpWeight::cells ? 1 : weight_of(weight, first, second);
}

double slip_weight(WarpWeight weight, int64_t first, int64_t second) {
    return weight == WarpWeight::cells ? 0 : weight_of(weight, first, second);
}

/// Where a path may end, and what it costs there. The cheapest is the one to take, then the one
/// that slips least.
struct PathEnd {
    double total = infinite;
    int64_t first_slip = 0, second_slip = 0;

    auto order() const { return std::tuple(total, first_slip + second_slip, second_slip); }
};

std::vector<TableStep> weighted_steps(const WarpOptions& options) {
    std::vector<TableStep> steps;
    for (const WarpStep& step : options.steps) {
        const double weight = cell_weight(options.weight, step.first, step.second);
        steps.push_back({step.first, step.second, weight});
    }
    return steps;
}

/// The table of two sequences from their beginnings to their ends, row after row. `Rows` are those
/// of the first sequence, or of the distances between the two.
template <class Rows>
class WarpTable {
  public:
    WarpTable(const Rows& rows, WarpFront front, const WarpOptions& options,
              std::vector<RowRange> region)
        : given_(rows), options_(options), region_(std::move(region)), front_(std::move(front)) {}

    int64_t rows() const { return given_.rows(); }
    int64_t columns() const { return front_.columns(); }
    void advance() {
        front_.advance(given_.row(row_).data(), region_[static_cast<size_t>(row_)], start());
        look_for_ends();
        row_least_.push_back(least_of_latest());
        ++row_;
    }

    /// Of the latest row.
    std::span<const uint8_t> choices() const { return front_.choices(); }
    const PathEnd& best_end() const { return best_end_; }

    /// No path from here on costs less, as long as paths neither begin nor end any more.
    double least_total() const {
        if (row_ <= options_.end_slip || row_ >= rows() - options_.end_slip) return 0;
        const int64_t reach = std::min(front_.depth() - 1, row_);
        return std::ranges::min(std::span(row_least_).last(static_cast<size_t>(reach)));
    }

  private:
    double least_of_latest() const {
        const RowRange& columns = region_[static_cast<size_t>(row_)];
        const auto totals = front_.totals().subspan(size_t(columns.first), size_t(columns.size()));
        double least = infinite;
        for (const double total : totals) least = total < least ? total : least;
        return least;
    }

    TableStart start() const {
        if (row_ > options_.end_slip) return {};
        const double weight = cell_weight(options_.weight, row_ + 1, 1);
        if (row_ > 0) return {1, weight};
        return {options_.end_slip + 1, weight, slip_weight(options_.weight, 0, 1)};
    }

    void look_for_ends() {
        const int64_t left = rows() - 1 - row_;
        if (left > options_.end_slip) return;
        const int64_t slips = left > 0 ? 0 : options_.end_slip;
        for (int64_t slip = 0; slip <= std::min(slips, columns() - 1); ++slip) {
            const auto column = static_cast<size_t>(columns() - 1 - slip);
            PathEnd end{front_.totals()[column], left, slip};
            if (end.total == infinite) continue;
            end.total += slip_weight(options_.weight, left, slip) * front_.distances()[column];
            if (end.order() < best_end_.order()) best_end_ = end;
        }
    }

    const Rows& given_;
    const WarpOptions& options_;
    const std::vector<RowRange> region_;
    WarpFront front_;
    PathEnd best_end_;
    std::vector<double> row_least_;  ///< of each row so far, the least cost of a path to it
    int64_t row_ = 0;
};

bool crossable(std::span<const RowRange> region) {
    return std::ranges::any_of(region, [](const RowRange& row) { return row.size() > 0; });
}

/// Follows the choices from an end of the table to the beginning.
template <class Rows>
std::vector<WarpCell> trace(const std::vector<uint8_t>& choices, const WarpTable<Rows>& table,
                            std::span<const WarpStep> steps) {
    std::vector<WarpCell> cells;
    int64_t i = table.rows() - 1 - table.best_end().first_slip;
    int64_t j = table.columns() - 1 - table.best_end().second_slip;
    for (;;) {
        cells.push_back({static_cast<int32_t>(i), static_cast<int32_t>(j)});
        const uint8_t choice = choices[static_cast<size_t>(i * table.columns() + j)];
        if (choice == WarpFront::begins_here) break;
        i -= steps[choice - 1U].first;
        j -= steps[choice - 1U].second;
    }
    std::ranges::reverse(cells);
    return cells;
}

template <class Rows>
WarpPath best_path(WarpTable<Rows> table, const WarpOptions& options) {
    std::vector<uint8_t> choices;
    choices.reserve(static_cast<size_t>(table.rows() * table.columns()));
    for (int64_t i = 0; i < table.rows(); ++i) {
        table.advance();
        choices.insert(choices.end(), table.choices().begin(), table.choices().end());
    }
    WarpPath path;
    path.total = table.best_end().total;
    if (path.total == infinite) return path;
    path.cells = trace(choices, table, options.steps);
    path.mean = path.total / (options.weight == WarpWeight::cells
                                  ? double(path.cells.size())
                                  : weight_of(options.weight, table.rows(), table.columns()));
    return path;
}

void check(const WarpOptions& options) {
    check(options.steps);
    if (options.end_slip < 0) throw std::invalid_argument("a warping path cannot slip below 0");
}

}  // namespace

WarpPath warp(const MatrixFView& first, const MatrixFView& second, const WarpOptions& options) {
    check_columns(first, second);
    check(options);
    auto region = warp_region(first.rows(), second.rows(), options.steps, options.end_slip);
    if (!crossable(region)) return {};
    WarpFront front(second, weighted_steps(options), options.radius, true);
    return best_path(WarpTable(first, std::move(front), options, std::move(region)), options);
}

WarpPath warp(const MatrixDView& distances, const WarpOptions& options) {
    check(options);
    auto region = warp_region(distances.rows(), distances.cols(), options.steps, options.end_slip);
    if (!crossable(region)) return {};
    WarpFront front(distances.cols(), weighted_steps(options), options.radius, true);
    return best_path(WarpTable(distances, std::move(front), options, std::move(region)), options);
}

namespace {

double squared_distance(const MatrixFView& first, int64_t i, const MatrixFView& second, int64_t j) {
    return (first.row(i).cast<double>() - second.row(j).cast<double>()).squaredNorm();
}

/// Whether the rows at either end allow a path: most sequences of other movements do not meet
/// there.
bool ends_meet(const MatrixFView& first, const MatrixFView& second, const WarpOptions& options) {
    // Summed in another order than in the table; the table decides what lies so near to the radius.
    const double limit = options.radius * options.radius * (1 + 1e-9);
    const int64_t n = first.rows(), m = second.rows();
    bool begin = false, end = false;
    for (int64_t slip = 0; slip <= options.end_slip; ++slip) {
        if (slip < n) {
            begin = begin || squared_distance(first, slip, second, 0) <= limit;
            end = end || squared_distance(first, n - 1 - slip, second, m - 1) <= limit;
        }
        if (slip < m) {
            begin = begin || squared_distance(first, 0, second, slip) <= limit;
            end = end || squared_distance(first, n - 1, second, m - 1 - slip) <= limit;
        }
    }
    return begin && end;
}

}  // namespace

double warp_cost(const MatrixFView& first, const MatrixFView& second, const WarpOptions& options,
                 double at_most) {
    if (options.weight == WarpWeight::cells) {
        const double mean = warp(first, second, options).mean;
        return mean <= at_most ? mean : infinite;
    }
    check_columns(first, second);
    check(options);
    if (first.rows() == 0 || second.rows() == 0) return infinite;
    if (options.radius < infinite && !ends_meet(first, second, options)) return infinite;
    auto region = warp_region(first.rows(), second.rows(), options.steps, options.end_slip);
    if (!crossable(region)) return infinite;
    WarpFront front(second, weighted_steps(options), options.radius, false);
    WarpTable table(first, std::move(front), options, std::move(region));
    const double weight = weight_of(options.weight, first.rows(), second.rows());
    // A little more than the bound, so that rounding never gives up what the division would let in.
    const double hopeless = at_most * weight * (1 + 1e-12);
    for (int64_t i = 0; i < table.rows(); ++i) {
        table.advance();
        if (table.least_total() > hopeless) return infinite;
    }
    const double mean = table.best_end().total / weight;
    return mean <= at_most ? mean : infinite;
}

namespace {

struct Match {
    double mean;
    RowRange rows;
};

/// The best path to each row of the sequence, where it is good enough.
std::vector<Match> match_ends(const MatrixFView& query, const MatrixFView& sequence,
                              const MatchOptions& options) {
    std::vector<TableStep> turned;
    for (const WarpStep& step : options.steps)
        turned.push_back({step.second, step.first, double(step.first)});
    WarpFront front(query, std::move(turned), options.radius, true);
    const int64_t columns = front.columns();
    std::vector<std::vector<int64_t>> begins(static_cast<size_t>(front.depth()));
    for (auto& row : begins) row.resize(static_cast<size_t>(columns));

    std::vector<Match> ends;
    for (int64_t i = 0; i < sequence.rows(); ++i) {
        front.advance(sequence.row(i).data(), {0, columns}, {1, 1.0});
        auto& latest = begins[static_cast<size_t>(i % front.depth())];
        for (int64_t j = 0; j < columns; ++j) {
            int64_t& begin = latest[static_cast<size_t>(j)];
            const uint8_t choice = front.choices()[static_cast<size_t>(j)];
            if (choice == WarpFront::begins_here) {
                begin = i;
            } else {
                const TableStep& step = front.steps()[choice - 1U];
                const auto from = static_cast<size_t>((i - step.rows) % front.depth());
                begin = begins[from][static_cast<size_t>(j - step.columns)];
            }
        }
        const double mean = front.totals().back() / double(columns);
        if (mean <= options.at_most) ends.push_back({mean, {latest.back(), i + 1}});
    }
    return ends;
}

/// The cheapest, then the cheapest of those that do not overlap it, and so on.
std::vector<Match> without_overlaps(std::vector<Match> matches, int64_t sequence_rows) {
    std::ranges::stable_sort(matches, {}, &Match::mean);
    std::vector<bool> taken(static_cast<size_t>(sequence_rows), false);
    std::erase_if(matches, [&](const Match& match) {
        const auto begin = taken.begin() + match.rows.first, end = taken.begin() + match.rows.end;
        if (std::find(begin, end, true) != end) return true;
        std::fill(begin, end, true);
        return false;
    });
    std::ranges::sort(matches, {}, [](const Match& match) { return match.rows.first; });
    return matches;
}

}  // namespace

std::vector<WarpPath> warp_matches(const MatrixFView& query, const MatrixFView& sequence,
                                   const MatchOptions& options) {
    check_columns(query, sequence);
    check(options.steps);
    if (std::ranges::any_of(options.steps, [](const WarpStep& step) { return step.first == 0; })) {
        throw std::invalid_argument("each step of a match must go on in the query");
    }
    if (query.rows() == 0) return {};
    const WarpOptions inside{options.steps, WarpWeight::first, 0, options.radius};
    std::vector<WarpPath> paths;
    for (const Match& match :
         without_overlaps(match_ends(query, sequence, options), sequence.rows())) {
        const auto window = sequence.middleRows(match.rows.first, match.rows.size());
        WarpPath path = warp(query, window, inside);
        for (WarpCell& cell : path.cells) cell.second += static_cast<int32_t>(match.rows.first);
        paths.push_back(std::move(path));
    }
    return paths;
}

}  // namespace kinetome
