// The rows a k-means++ start is drawn from, in balls: a new centre is compared only with the rows
// it can come nearer to.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "kinetome/base/parallel.h"
#include "kinetome/math/row_source.h"
#include "lanes.h"

namespace kinetome {

// Consecutive rows are near each other in motion: balls around 16 rows (a tile), 16 tiles (a super)
// and 16 supers (a block) tell which of them a new centre can come nearer to.
inline constexpr int64_t fan_out = 16;
inline constexpr int64_t sample_block_rows = fan_out * fan_out * fan_out;

inline int64_t parents_of(int64_t count) {
    return (count + fan_out - 1) / fan_out;
}

/// Squared distances from one point to 16 others stored dimension by dimension (d × 16).
inline void squared_distances(const float* members, const std::vector<float>& point,
                              float* squared) {
    for (int64_t first = 0; first < fan_out; first += lane_count) {
        Lanes sum{};
        for (size_t j = 0; j < point.size(); ++j) {
            const Lanes difference = load_lanes(members + j * fan_out + first) - point[j];
            sum += difference * difference;
        }
        store_lanes(sum, squared + first);
    }
}

/// Index of the entry in which `target`, a point of [0, Σ), falls; what is left of the target is
/// its place inside that entry. Entries of nothing are never chosen.
template <class Value>
size_t entry_holding(std::span<const Value> weights, double& target) {
    size_t last = 0;
    for (size_t i = 0; i < weights.size(); ++i) {
        const auto weight = static_cast<double>(weights[i]);
        if (!(weight > 0)) continue;
        last = i;
        if (target < weight) break;
        target -= weight;
    }
    return last;
}

/// Balls around the members of one level, 16 to a parent, and how far the rows in them are from
/// the centres chosen so far.
struct BallLevel {
    BallLevel(int64_t member_count, int64_t dimension)
        : count(member_count),
          centres(padded(count) * static_cast<size_t>(dimension)),
          radius(padded(count)),
          farthest(padded(count), std::numeric_limits<float>::infinity()),
          reach_squared(padded(count), -1.0F),
          weight(padded(count)) {
        std::fill_n(reach_squared.begin(), count, std::numeric_limits<float>::infinity());
    }

    void set_farthest(int64_t member, float distance) {
        // Far above the rounding of the distances: a row that comes nearer is never skipped.
        constexpr float margin = 1e-4F;
        const auto m = static_cast<size_t>(member);
        const float reach = (radius[m] + distance) * (1 + margin);
        farthest[m] = distance;
        reach_squared[m] = reach * reach;
    }

    /// Bit i is set when a new centre can come nearer to a row of the parent's i-th member.
    uint32_t reachable(int64_t parent, const std::vector<float>& centre) const {
        float squared[fan_out];
        const auto dimension = static_cast<int64_t>(centre.size());
        squared_distances(centres.data() + parent * fan_out * dimension, centre, squared);
        uint32_t bits = 0;
        for (int64_t first = 0; first < fan_out; first += lane_count) {
            const float* const reach = reach_squared.data() + parent * fan_out + first;
            bits |= lanes_greater(load_lanes(reach), load_lanes(squared + first)) << first;
        }
        return bits;
    }

    static size_t padded(int64_t count) {
        return static_cast<size_t>((count + fan_out - 1) / fan_out * fan_out);
    }

    int64_t count;
    LaneBuffer centres;           ///< parents × d × 16
    std::vector<float> radius;    ///< of the ball that holds all rows below
    std::vector<float> farthest;  ///< largest distance of a row below to its nearest centre
    LaneBuffer reach_squared;     ///< a centre beyond this distance to the ball's changes nothing
    std::vector<double> weight;   ///< Σ of squared distances below
};

/// Rows the start is drawn from, a part of them (of a rank) in memory, each with its distance to
/// the nearest centre chosen so far.
class StartSample {
  public:
    /// `count` rows in all, evenly spaced in `rows`; of these the ones in `blocks` (of 4,096 each).
    StartSample(const RowSource& rows, int64_t count, const RowRange& blocks, int threads)
        : whole_count_(count),
          first_(blocks.first * sample_block_rows),
          count_(std::max<int64_t>(std::min(count, blocks.end * sample_block_rows) - first_, 0)),
          dimension_(rows.columns()),
          threads_(threads),
          tiles_(parents_of(count_), dimension_),
          supers_(parents_of(tiles_.count), dimension_),
          blocks_(parents_of(supers_.count), dimension_),
          values_(static_cast<size_t>(tiles_.count * fan_out * dimension_)),
          squared_(static_cast<size_t>(tiles_.count * fan_out)) {
        parallel_for(threads_, blocks_.count, [&](int64_t block) {
            for_members(block, supers_, [&](int64_t super) { load_super(rows, super); });
        });
    }

    std::vector<float> row(int64_t index) const {
        std::vector<float> values(static_cast<size_t>(dimension_));
        for (int64_t j = 0; j < dimension_; ++j) values[size_t(j)] = values_[place(index, j)];
        return values;
    }

    void add_centre(const std::vector<float>& centre) {
        parallel_for(threads_, blocks_.count, [&](int64_t block) {
            if (update(supers_, block, centre,
                       [&](int64_t super) { return update_super(super, centre); })) {
                gather(supers_, block, blocks_);
            }
        });
    }

    /// Of each block, Σ of squared distances to the nearest centre; infinite where one is more than
    /// a float can hold.
    std::vector<double> block_weights() const {
        std::vector<double> weights(static_cast<size_t>(blocks_.count));
        for (size_t block = 0; block < weights.size(); ++block) {
            const bool beyond = std::isinf(blocks_.farthest[block]);
            weights[block] =
                beyond ? std::numeric_limits<double>::infinity() : blocks_.weight[block];
        }
        return weights;
    }

    /// The row at `target` in [0, weight of the block), rows laid end to end by their distance.
    std::vector<float> row_at(int64_t block, double target) const {
        const int64_t super = member_at(block, supers_, target);
        const int64_t tile = member_at(super, tiles_, target);
        const std::span<const float> squared(squared_.data() + tile * fan_out, fan_out);
        return row(tile * fan_out + static_cast<int64_t>(entry_holding<float>(squared, target)));
    }

  private:
    template <class Visit>
    static void for_members(int64_t parent, const BallLevel& level, Visit&& visit) {
        const int64_t end = std::min((parent + 1) * fan_out, level.count);
        for (int64_t member = parent * fan_out; member < end; ++member) visit(member);
    }

    static int64_t member_at(int64_t parent, const BallLevel& level, double& target) {
        const int64_t first = parent * fan_out;
        const auto size = static_cast<size_t>(std::min(fan_out, level.count - first));
        const std::span<const double> weights(level.weight.data() + first, size);
        return first + static_cast<int64_t>(entry_holding<double>(weights, target));
    }

    /// Where value j of member `index` is in an array of parents × d × 16.
    size_t place(int64_t index, int64_t j) const {
        const int64_t parent = index / fan_out;
        return static_cast<size_t>((parent * dimension_ + j) * fan_out + index % fan_out);
    }

    void load_super(const RowSource& rows, int64_t super) {
        constexpr int64_t super_count = fan_out * fan_out;
        const int64_t end = std::min((super + 1) * super_count, count_);
        const RowRange range{source_row(rows, super * super_count), source_row(rows, end - 1) + 1};
        const RowBlock block = rows.read(range);
        const auto values = block.view();
        for_members(super, tiles_, [&](int64_t tile) {
            load_tile(tile,
                      [&](int64_t i) { return values.row(source_row(rows, i) - range.first); });
        });
        enclose(tiles_, super, supers_);
    }

    template <class RowOf>
    void load_tile(int64_t tile, RowOf&& row_of) {
        const int64_t first = tile * fan_out, end = std::min(first + fan_out, count_);
        std::vector<float> centre(static_cast<size_t>(dimension_));
        for (int64_t j = 0; j < dimension_; ++j) {
            double sum = 0;
            for (int64_t i = first; i < end; ++i) {
                const float value = row_of(i)[j];
                values_[place(i, j)] = value;
                sum += double(value);
            }
            centre[size_t(j)] = static_cast<float>(sum / static_cast<double>(end - first));
            tiles_.centres[place(tile, j)] = centre[size_t(j)];
        }
        float squared[fan_out];
        squared_distances(values_.data() + first * dimension_, centre, squared);
        float largest = 0;
        for (int64_t i = 0; i < end - first; ++i) largest = std::max(largest, squared[i]);
        tiles_.radius[size_t(tile)] = std::sqrt(largest);
    }

    /// Evenly spaced when the sample is smaller than the matrix.
    int64_t source_row(const RowSource& rows, int64_t index) const {
        return (first_ + index) * rows.rows() / whole_count_;
    }

    void enclose(const BallLevel& members, int64_t parent, BallLevel& parents) const {
        std::vector<float> centre(static_cast<size_t>(dimension_));
        for (int64_t j = 0; j < dimension_; ++j) {
            double sum = 0;
            int64_t count = 0;
            for_members(parent, members, [&](int64_t member) {
                sum += double(members.centres[place(member, j)]);
                ++count;
            });
            centre[size_t(j)] = static_cast<float>(sum / static_cast<double>(count));
            parents.centres[place(parent, j)] = centre[size_t(j)];
        }
        float squared[fan_out];
        squared_distances(members.centres.data() + parent * fan_out * dimension_, centre, squared);
        float radius = 0;
        for_members(parent, members, [&](int64_t member) {
            const float distance = std::sqrt(squared[member % fan_out]);
            radius = std::max(radius, distance + members.radius[size_t(member)]);
        });
        parents.radius[size_t(parent)] = radius;
    }

    /// Calls `descend` for the members the centre may come nearer to; whether any was changed.
    template <class Descend>
    static bool update(const BallLevel& members, int64_t parent, const std::vector<float>& centre,
                       Descend&& descend) {
        bool changed = false;
        for (uint32_t left = members.reachable(parent, centre); left != 0; left &= left - 1) {
            changed |= descend(parent * fan_out + std::countr_zero(left));
        }
        return changed;
    }

    bool update_super(int64_t super, const std::vector<float>& centre) {
        const bool changed =
            update(tiles_, super, centre, [&](int64_t tile) { return update_tile(tile, centre); });
        if (changed) gather(tiles_, super, supers_);
        return changed;
    }

    bool update_tile(int64_t tile, const std::vector<float>& centre) {
        float distances[fan_out];
        const int64_t first = tile * fan_out;
        squared_distances(values_.data() + first * dimension_, centre, distances);
        const bool initial = std::isinf(tiles_.farthest[size_t(tile)]);
        bool changed = false;
        float largest = 0;
        double sum = 0;
        for (int64_t i = 0; i < std::min(fan_out, count_ - first); ++i) {
            float& nearest = squared_[static_cast<size_t>(first + i)];
            if (initial || distances[i] < nearest) {
                nearest = distances[i];
                changed = true;
            }
            largest = std::max(largest, nearest);
            sum += double(nearest);
        }
        tiles_.set_farthest(tile, std::sqrt(largest));
        tiles_.weight[size_t(tile)] = sum;
        return changed;
    }

    static void gather(const BallLevel& members, int64_t parent, BallLevel& parents) {
        float farthest = 0;
        double sum = 0;
        for_members(parent, members, [&](int64_t member) {
            farthest = std::max(farthest, members.farthest[size_t(member)]);
            sum += members.weight[size_t(member)];
        });
        parents.set_farthest(parent, farthest);
        parents.weight[size_t(parent)] = sum;
    }

    int64_t whole_count_;  ///< rows of all parts
    int64_t first_;        ///< number of this part's first row among them
    int64_t count_;
    int64_t dimension_;
    int threads_;
    BallLevel tiles_, supers_, blocks_;  ///< of the blocks, only weights are used
    LaneBuffer values_;                  ///< tiles × d × 16
    std::vector<float> squared_;         ///< of each row, to the nearest centre
};

}  // namespace kinetome
