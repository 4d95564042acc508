#include <algorithm>
#include <cmath>
#include <limits>

#include "signature_ends.h"

namespace kinetome {
namespace {

constexpr float unreachable = std::numeric_limits<float>::infinity();

/// Runs of a signature at the frames that are compared.
std::vector<int32_t> sampled_runs(std::span<const SignatureRun> signature, int64_t samples,
                                  double spacing) {
    std::vector<int32_t> runs(static_cast<size_t>(samples));
    int32_t run = 0;
    for (int64_t i = 0; i < samples; ++i) {
        const auto frame = static_cast<int64_t>((static_cast<double>(i) + 0.5) * spacing);
        while (signature[static_cast<size_t>(run)].end_frame() <= frame) ++run;
        runs[static_cast<size_t>(i)] = run;
    }
    return runs;
}

/// One row of the table, with room for steps that come from before its first column.
struct TableRow {
    static constexpr int64_t margin = 2;
    std::vector<float> totals;
    std::vector<int32_t> begins;  ///< column in which the path to each cell begins

    explicit TableRow(int64_t columns)
        : totals(static_cast<size_t>(margin + columns), unreachable),
          begins(static_cast<size_t>(margin + columns), 0) {}
    float* total() { return totals.data() + margin; }
    int32_t* begin() { return begins.data() + margin; }
};

/// Comes to all cells of a row from those `columns` before them in an earlier row.
void come_by(TableRow& from, int64_t columns, float weight, const float* distances, TableRow& to,
             int64_t count) {
    const float* const __restrict source = from.total() - columns;
    const int32_t* const __restrict source_begin = from.begin() - columns;
    float* const __restrict total = to.total();
    int32_t* const __restrict begin = to.begin();
    for (int64_t j = 0; j < count; ++j) {
        const float candidate = source[j] + weight * distances[j];
        const bool nearer = candidate < total[j];
        total[j] = nearer ? candidate : total[j];
        begin[j] = nearer ? source_begin[j] : begin[j];
    }
}

/// The table of the frames compared, query row after query row.
class PacedTable {
  public:
    PacedTable(std::vector<int32_t> text_runs, const MatrixFView& distances)
        : text_runs_(std::move(text_runs)),
          distances_(distances),
          at_run_(text_runs_.size()),
          rows_(3, TableRow(columns())) {}

    int64_t columns() const { return static_cast<int64_t>(text_runs_.size()); }

    void advance(int32_t query_run) {
        measure(query_run);
        TableRow& row = row_before(0);
        std::fill_n(row.total(), columns(), unreachable);
        if (row_ == 0) {
            for (int64_t j = 0; j < columns(); ++j) {
                row.total()[j] = at_run_[static_cast<size_t>(j)];
                row.begin()[j] = static_cast<int32_t>(j);
            }
        } else {
            come_by(row_before(1), 1, 1, at_run_.data(), row, columns());
            come_by(row_before(1), 2, 1, at_run_.data(), row, columns());
            if (row_ > 1) come_by(row_before(2), 1, 2, at_run_.data(), row, columns());
        }
        ++row_;
    }

    /// Of the latest row.
    TableRow& latest() { return row_before(1); }

  private:
    TableRow& row_before(int64_t rows) { return rows_[static_cast<size_t>((row_ + 3 - rows) % 3)]; }

    /// Distances along a row are those of its run: often the same as along the row before.
    void measure(int32_t query_run) {
        if (query_run == measured_) return;
        measured_ = query_run;
        const float* const row = distances_.data() + query_run * distances_.outerStride();
        for (size_t j = 0; j < text_runs_.size(); ++j) at_run_[j] = row[text_runs_[j]];
    }

    std::vector<int32_t> text_runs_;
    MatrixFView distances_;
    std::vector<float> at_run_;  ///< from the query run at hand, by column
    std::vector<TableRow> rows_;
    int32_t measured_ = -1;
    int64_t row_ = 0;
};

}  // namespace

std::vector<SignatureMatch> paced_ends(std::span<const SignatureRun> query,
                                       std::span<const SignatureRun> text,
                                       const MatrixFView& distances, int32_t step) {
    const int64_t frames = frame_count(query), text_frames = frame_count(text);
    const int64_t rows = std::max<int64_t>(1, std::llround(double(frames) / step));
    const int64_t columns = text_frames / step;
    PacedTable table(sampled_runs(text, columns, step), distances);
    for (const int32_t run : sampled_runs(query, rows, double(frames) / double(rows))) {
        table.advance(run);
    }
    std::vector<SignatureMatch> ends;
    for (int64_t j = 0; j < columns; ++j) {
        const float total = table.latest().total()[j];
        if (total == unreachable) continue;
        ends.push_back({{int64_t{table.latest().begin()[j]} * step, (j + 1) * step},
                        double(total) / double(rows)});
    }
    return ends;
}

}  // namespace kinetome
