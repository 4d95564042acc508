// The peer of the signature index: dynamic time warping of a query against every part of every
// take, at most twice as fast or slow, the distances counted by the query's frames.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/signature_index.h"

namespace kinetome::bench {

/// Rows of features in blocks of eight, so that eight distances are measured at once.
class LaneRows {
  public:
    explicit LaneRows(const MatrixF& rows)
        : rows_(rows.rows()),
          columns_(rows.cols()),
          values_(static_cast<size_t>((rows.rows() + lanes - 1) / lanes * lanes * rows.cols()), 0) {
        for (int64_t i = 0; i < rows_; ++i) {
            for (int64_t c = 0; c < columns_; ++c) {
                values_[size_t(((i / lanes) * columns_ + c) * lanes + i % lanes)] = rows(i, c);
            }
        }
    }

    int64_t rows() const { return rows_; }
    /// From one row to all, rounded up to whole blocks.
    void distances(const float* __restrict from, float* __restrict to) const {
        for (int64_t block = 0; block * lanes < rows_; ++block) {
            const float* const __restrict values = values_.data() + block * columns_ * lanes;
            float squares[lanes] = {};
            for (int64_t c = 0; c < columns_; ++c) {
                for (int64_t lane = 0; lane < lanes; ++lane) {
                    const float difference = from[c] - values[c * lanes + lane];
                    squares[lane] += difference * difference;
                }
            }
            for (int64_t lane = 0; lane < lanes; ++lane) {
                to[block * lanes + lane] = std::sqrt(squares[lane]);
            }
        }
    }

    static constexpr int64_t lanes = 8;

  private:
    int64_t rows_, columns_;
    std::vector<float> values_;
};

class ExhaustiveWarp {
  public:
    /// n × d features of each take, `stride` frames from row to row.
    ExhaustiveWarp(const std::vector<MatrixF>& takes, int64_t stride) : stride_(stride) {
        for (const MatrixF& take : takes) takes_.emplace_back(take);
    }

    /// The k nearest places of a query.
    std::vector<IndexedMatch> search(const MatrixF& query, int64_t k, double overlap) const {
        std::vector<IndexedMatch> ends;
        for (size_t take = 0; take < takes_.size(); ++take) {
            find_ends(query, static_cast<int32_t>(take), ends);
        }
        // Of ends that are no candidates for the k nearest nothing needs to be known.
        for (size_t kept = size_t(k) * 64;; kept *= 4) {
            std::vector<IndexedMatch> some = ends;
            if (kept < some.size()) {
                std::nth_element(some.begin(), some.begin() + int64_t(kept), some.end(),
                                 [](const auto& a, const auto& b) {
                                     return a.match.distance < b.match.distance;
                                 });
                some.resize(kept);
            }
            auto found = nearest_matches(std::move(some), k, overlap);
            if (int64_t(found.size()) == k || kept >= ends.size()) return found;
        }
    }

    /// The least cost of the query in any part of some rows.
    static double least_cost(const MatrixF& query, const MatrixF& rows) {
        std::vector<IndexedMatch> ends;
        ExhaustiveWarp({rows}, 1).find_ends(query, 0, ends);
        double least = std::numeric_limits<double>::infinity();
        for (const IndexedMatch& end : ends) least = std::min(least, end.match.distance);
        return least;
    }

  private:
    struct Row {
        std::vector<float> totals;
        std::vector<int32_t> begins;
        explicit Row(int64_t columns)
            : totals(size_t(columns + 2), std::numeric_limits<float>::infinity()),
              begins(size_t(columns + 2), 0) {}
    };

    static void come_by(const Row& from, int64_t columns, float weight, const float* distances,
                        Row& to, int64_t count) {
        const float* const __restrict source = from.totals.data() + 2 - columns;
        const int32_t* const __restrict source_begin = from.begins.data() + 2 - columns;
        float* const __restrict total = to.totals.data() + 2;
        int32_t* const __restrict begin = to.begins.data() + 2;
        for (int64_t j = 0; j < count; ++j) {
            const float candidate = source[j] + weight * distances[j];
            const bool nearer = candidate < total[j];
            total[j] = nearer ? candidate : total[j];
            begin[j] = nearer ? source_begin[j] : begin[j];
        }
    }

    void find_ends(const MatrixF& query, int32_t take, std::vector<IndexedMatch>& ends) const {
        const LaneRows& text = takes_[size_t(take)];
        const int64_t columns = text.rows();
        std::vector<float> distances(size_t(columns + LaneRows::lanes));
        std::vector<Row> rows(3, Row(columns));
        for (int64_t i = 0; i < query.rows(); ++i) {
            text.distances(query.row(i).data(), distances.data());
            Row& row = rows[size_t(i % 3)];
            std::fill(row.totals.begin(), row.totals.end(), std::numeric_limits<float>::infinity());
            if (i == 0) {
                std::copy_n(distances.begin(), columns, row.totals.begin() + 2);
                for (int64_t j = 0; j < columns; ++j) row.begins[size_t(j + 2)] = int32_t(j);
                continue;
            }
            const Row& last = rows[size_t((i + 2) % 3)];
            come_by(last, 1, 1, distances.data(), row, columns);
            come_by(last, 2, 1, distances.data(), row, columns);
            if (i > 1) come_by(rows[size_t((i + 1) % 3)], 1, 2, distances.data(), row, columns);
        }
        const Row& row = rows[size_t((query.rows() - 1) % 3)];
        for (int64_t j = 0; j < columns; ++j) {
            const float total = row.totals[size_t(j + 2)];
            if (total == std::numeric_limits<float>::infinity()) continue;
            ends.push_back({take,
                            {{row.begins[size_t(j + 2)] * stride_, (j + 1) * stride_},
                             double(total) / double(query.rows())}});
        }
    }

    int64_t stride_;
    std::vector<LaneRows> takes_;
};

}  // namespace kinetome::bench
