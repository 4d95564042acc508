#include "kinetome/models/label_transfer.h"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>

#include "kinetome/base/parallel.h"
#include "primitive_rows.h"

namespace kinetome {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Frames of a query that are searched for together; most queries end after a few.
constexpr int64_t frames_at_once = 8;

/// Columns that no path enters, before each run: as many as a step may pass over.
constexpr int32_t gap = 2;

/// Step of a path: slope_limited_steps, weighted by the query's frames.
struct Step {
    size_t frames = 1;
    int32_t columns = 1;
};
constexpr std::array<Step, 3> steps = {{{1, 1}, {1, 2}, {2, 1}}};

/// Where a path over the whole query ends; the cheapest is the least.
struct Arrival {
    double total = infinite;
    int32_t column = 0, source = -1;
    auto operator<=>(const Arrival&) const = default;
};

/// The cheapest path to a frame of the query and a column.
struct Cell {
    double total = infinite;
    int32_t begin = 0;  ///< column
};

}  // namespace

/// Subsequence dynamic time warping over the cells of a neighbourhood graph alone.
class KnowledgeBase::Search {
  public:
    explicit Search(int64_t columns) {
        for (auto& row : rows_) row.resize(static_cast<size_t>(columns));
    }

    /// Goes on by one frame of the query, with the columns near it and their distances.
    void advance(std::span<const int32_t> columns, std::span<const float> distances) {
        std::ranges::rotate(rows_, rows_.end() - 1);
        std::ranges::rotate(touched_, touched_.end() - 1);
        for (const int32_t column : touched_[0]) cell(0, column) = {};
        touched_[0].assign(columns.begin(), columns.end());
        for (size_t i = 0; i < columns.size(); ++i) {
            const Cell best = cheapest(columns[i], double(distances[i]));
            cell(0, columns[i]) = best;
            if (best.total < infinite) latest_ = frames_ + 1;
        }
        ++frames_;
    }

    /// Whether a path may still come to the query's end.
    bool goes_on() const { return frames_ - latest_ < int64_t(rows_.size()) - 1; }

    /// The columns that paths over all frames so far may end in.
    std::span<const int32_t> ends() const { return touched_[0]; }
    const Cell& end(int32_t column) const { return rows_[0][static_cast<size_t>(column)]; }

  private:
    Cell& cell(size_t back, int32_t column) { return rows_[back][static_cast<size_t>(column)]; }

    Cell cheapest(int32_t column, double distance) {
        if (frames_ == 0) return {distance, column};
        Cell best;
        for (const Step& step : steps) {
            const Cell& from = cell(step.frames, column - step.columns);
            const double total = from.total + double(step.frames) * distance;
            if (total < best.total) best = {total, from.begin};
        }
        return best;
    }

    std::array<std::vector<Cell>, 3> rows_;  ///< of the latest frame and the two before it
    std::array<std::vector<int32_t>, 3> touched_;
    int64_t frames_ = 0, latest_ = 0;  ///< of the query; of these, up to the last that a path meets
};

KnowledgeBase::KnowledgeBase(const MatrixFView& features,
                             std::span<const CorpusPrimitive> primitives,
                             std::span<const int32_t> labels, int threads) {
    if (primitives.size() != labels.size()) {
        throw std::invalid_argument("each known primitive must have one label");
    }
    require_rows(features, primitives);
    std::vector<int64_t> frames;
    for (size_t p = 0; p < primitives.size(); ++p) {
        if (labels[p] < 0) continue;
        const bool goes_on =
            p > 0 && labels[p - 1] == labels[p] && adjoin(primitives[p - 1], primitives[p]);
        if (!goes_on) columns_.resize(columns_.size() + gap);
        const RowRange& rows = primitives[p].rows;
        for (int64_t row = rows.first; row < rows.end; ++row) {
            frames.push_back(row);
            column_of_.push_back(static_cast<int32_t>(columns_.size()));
            columns_.push_back(
                {labels[p], static_cast<int32_t>(p), static_cast<int32_t>(rows.size())});
        }
    }
    if (!frames.empty()) index_.emplace(features(frames, Eigen::all), KnnEngine::blocks, threads);
}

KnowledgeBase::Search KnowledgeBase::search_for(const MatrixFView& primitive, double radius) const {
    Search search(static_cast<int64_t>(columns_.size()));
    std::vector<int32_t> columns;
    for (int64_t first = 0; first < primitive.rows() && search.goes_on(); first += frames_at_once) {
        const int64_t count = std::min(frames_at_once, primitive.rows() - first);
        const NeighbourLists near =
            index_->search(primitive.middleRows(first, count), {radius, index_->rows()}, 1);
        for (int64_t i = 0; i < count; ++i) {
            columns.clear();
            for (const int32_t row : near.rows_of(i)) columns.push_back(column_of_[size_t(row)]);
            search.advance(columns, near.distances_of(i));
        }
    }
    return search;
}

LabelGuess KnowledgeBase::label_of(const MatrixFView& primitive,
                                   const LabelTransferOptions& options) const {
    if (!index_ || primitive.rows() == 0) return {};
    const Search search = search_for(primitive, options.radius);
    std::map<int32_t, Arrival> by_label;
    for (const int32_t end : search.ends()) {
        const Cell& cell = search.end(end);
        if (cell.total == infinite) continue;
        const Column& source = columns_[static_cast<size_t>((cell.begin + end) / 2)];
        if (end - cell.begin + 1 < options.cover * source.frames) continue;
        Arrival& cheapest = by_label[source.label];
        cheapest = std::min(cheapest, {cell.total, end, source.source});
    }
    const auto frames = double(primitive.rows());
    LabelGuess guess;
    for (const auto& [label, arrival] : by_label) {
        const double cost = arrival.total / frames;
        guess.rival = std::min(guess.rival, std::max(cost, guess.cost));
        if (!(cost < guess.cost)) continue;
        guess.cost = cost;
        guess.label = label;
        guess.source = arrival.source;
    }
    // Strictly: where two labels cost nothing, neither leads.
    const bool leads = guess.cost < options.lead * guess.rival;
    if (!(guess.cost <= options.threshold && leads)) guess.label = -1;
    return guess;
}

std::vector<LabelGuess> transfer_labels(const KnowledgeBase& known, const MatrixFView& features,
                                        std::span<const CorpusPrimitive> primitives,
                                        const LabelTransferOptions& options, int threads) {
    require_rows(features, primitives);
    std::vector<LabelGuess> guesses(primitives.size());
    parallel_for(threads, static_cast<int64_t>(primitives.size()), [&](int64_t i) {
        guesses[size_t(i)] = known.label_of(rows_of(features, primitives[size_t(i)]), options);
    });
    return guesses;
}

}  // namespace kinetome
