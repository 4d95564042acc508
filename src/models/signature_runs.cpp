#include <algorithm>
#include <limits>

#include "signature_ends.h"

namespace kinetome {
namespace {

constexpr double unreachable = std::numeric_limits<double>::infinity();

/// The nearest alignment to a cell: what it costs, and the run of the text it begins with.
struct Cell {
    double total = unreachable;
    int64_t begin = 0;
};

/// The nearer one; of equally near ones the first.
Cell nearer(const Cell& a, double cost_a, const Cell& b, double cost_b) {
    const double by_a = a.total + cost_a, by_b = b.total + cost_b;
    return by_b < by_a ? Cell{by_b, b.begin} : Cell{by_a, a.begin};
}

/// Distances that are cut off where leaves are simply different.
class RunCosts {
  public:
    RunCosts(const MatrixFView& distances, const SignatureMatchOptions& options)
        : distances_(distances), farthest_(options.farthest), gap_(options.gap) {}

    int64_t rows() const { return distances_.rows(); }
    int64_t columns() const { return distances_.cols(); }
    double replacement(int64_t i, int64_t j) const {
        return std::min(double(distances_(i, j)), farthest_);
    }
    /// Of run j of the text, behind run i of the query.
    double insertion(int64_t i, int64_t j) const {
        const double next = i + 1 < rows() ? replacement(i + 1, j) : unreachable;
        return std::min(replacement(i, j), next) + gap_;
    }
    /// Of run i of the query, behind run j of the text (-1: before the first).
    double omission(int64_t i, int64_t j) const {
        const double last = j >= 0 ? replacement(i, j) : unreachable;
        const double next = j + 1 < columns() ? replacement(i, j + 1) : unreachable;
        return std::min(last, next) + gap_;
    }

  private:
    MatrixFView distances_;
    double farthest_, gap_;
};

/// Each run answers one or several of the other signature's.
std::vector<Cell> repeated_ends(const RunCosts& costs) {
    const auto columns = static_cast<size_t>(costs.columns());
    std::vector<Cell> row(columns), before;
    for (int64_t i = 0; i < costs.rows(); ++i) {
        std::swap(row, before);
        row.assign(columns, {});
        for (size_t j = 0; j < columns; ++j) {
            const auto column = static_cast<int64_t>(j);
            const double cost = costs.replacement(i, column);
            if (i == 0) {
                row[j] = {cost, column};
            } else {
                row[j] = nearer(j > 0 ? before[j - 1] : Cell{}, cost, before[j], cost);
            }
            if (j > 0 && i > 0) row[j] = nearer(row[j], 0, row[j - 1], cost);
        }
    }
    return row;
}

/// Runs are replaced, inserted and left out; entry j + 1 of a row is run j of the text.
std::vector<Cell> edited_ends(const RunCosts& costs) {
    const auto columns = static_cast<size_t>(costs.columns());
    std::vector<Cell> row(columns + 1), before;
    for (size_t j = 0; j <= columns; ++j) row[j] = {0, static_cast<int64_t>(j)};
    for (int64_t i = 0; i < costs.rows(); ++i) {
        std::swap(row, before);
        row.assign(columns + 1, {});
        row[0] = {before[0].total + costs.omission(i, -1), 0};
        for (size_t j = 1; j <= columns; ++j) {
            const auto run = static_cast<int64_t>(j) - 1;
            row[j] =
                nearer(before[j - 1], costs.replacement(i, run), before[j], costs.omission(i, run));
            row[j] = nearer(row[j], 0, row[j - 1], costs.insertion(i, run));
        }
    }
    row.erase(row.begin());
    return row;
}

}  // namespace

std::vector<SignatureMatch> run_ends(std::span<const SignatureRun> query,
                                     std::span<const SignatureRun> text,
                                     const MatrixFView& distances,
                                     const SignatureMatchOptions& options) {
    const RunCosts costs(distances, options);
    const std::vector<Cell> cells =
        options.rule == MatchRule::repeats ? repeated_ends(costs) : edited_ends(costs);
    std::vector<SignatureMatch> ends;
    for (size_t j = 0; j < cells.size(); ++j) {
        const auto last = static_cast<int64_t>(j);
        if (cells[j].begin > last) continue;  // all of the query left out
        ends.push_back({matched_frames(query, text, cells[j].begin, last),
                        cells[j].total / double(query.size())});
    }
    return ends;
}

}  // namespace kinetome
