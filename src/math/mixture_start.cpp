#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "kinetome/base/parallel.h"
#include "kinetome/base/random.h"
#include "kinetome/math/mixture.h"
#include "lanes.h"
#include "mixture_input.h"

namespace kinetome {
namespace {

// Consecutive rows are near each other in motion: balls around 16 rows (a tile), 16 tiles (a super)
// and 16 supers (a block) tell which of them a new centre can come nearer to.
constexpr int64_t fan_out = 16;

/// Squared distances from one point to 16 others stored dimension by dimension (d × 16).
void squared_distances(const float* members, const std::vector<float>& point, float* squared) {
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
struct Level {
    Level(int64_t member_count, int64_t dimension)
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

/// The rows the start is drawn from, each with its distance to the nearest centre chosen so far.
class StartSample {
  public:
    StartSample(const MatrixFView& rows, int64_t count, int threads)
        : count_(count),
          dimension_(rows.cols()),
          threads_(threads),
          tiles_(parents_of(count), dimension_),
          supers_(parents_of(tiles_.count), dimension_),
          blocks_(parents_of(supers_.count), dimension_),
          values_(static_cast<size_t>(tiles_.count * fan_out * dimension_)),
          squared_(static_cast<size_t>(tiles_.count * fan_out)) {
        parallel_for(threads_, blocks_.count, [&](int64_t block) {
            for_members(block, supers_, [&](int64_t super) {
                for_members(super, tiles_, [&](int64_t tile) { load_tile(rows, tile); });
                enclose(tiles_, super, supers_);
            });
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

    /// Σ of squared distances to the nearest centre, blocks in order. Throws std::invalid_argument
    /// where a squared distance is more than a float can hold.
    double total_weight() const {
        double total = 0;
        for (int64_t block = 0; block < blocks_.count; ++block) {
            if (std::isinf(blocks_.farthest[size_t(block)])) {
                throw std::invalid_argument("the rows are too far apart to square distances");
            }
            total += blocks_.weight[size_t(block)];
        }
        return total;
    }

    /// The row at `target` in [0, total_weight()), rows laid end to end by their squared distance.
    int64_t row_at(double target) const {
        const auto block = static_cast<int64_t>(entry_holding<double>(blocks_.weight, target));
        const int64_t super = member_at(block, supers_, target);
        const int64_t tile = member_at(super, tiles_, target);
        const std::span<const float> squared(squared_.data() + tile * fan_out, fan_out);
        return tile * fan_out + static_cast<int64_t>(entry_holding<float>(squared, target));
    }

  private:
    static int64_t parents_of(int64_t count) { return (count + fan_out - 1) / fan_out; }

    template <class Visit>
    static void for_members(int64_t parent, const Level& level, Visit&& visit) {
        const int64_t end = std::min((parent + 1) * fan_out, level.count);
        for (int64_t member = parent * fan_out; member < end; ++member) visit(member);
    }

    static int64_t member_at(int64_t parent, const Level& level, double& target) {
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

    void load_tile(const MatrixFView& rows, int64_t tile) {
        const int64_t first = tile * fan_out, end = std::min(first + fan_out, count_);
        std::vector<float> centre(static_cast<size_t>(dimension_));
        for (int64_t j = 0; j < dimension_; ++j) {
            double sum = 0;
            for (int64_t i = first; i < end; ++i) {
                const float value = rows(source_row(rows.rows(), i), j);
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
    int64_t source_row(int64_t row_count, int64_t index) const {
        return index * row_count / count_;
    }

    void enclose(const Level& members, int64_t parent, Level& parents) const {
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
    static bool update(const Level& members, int64_t parent, const std::vector<float>& centre,
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

    static void gather(const Level& members, int64_t parent, Level& parents) {
        float farthest = 0;
        double sum = 0;
        for_members(parent, members, [&](int64_t member) {
            farthest = std::max(farthest, members.farthest[size_t(member)]);
            sum += members.weight[size_t(member)];
        });
        parents.set_farthest(parent, farthest);
        parents.weight[size_t(parent)] = sum;
    }

    int64_t count_;
    int64_t dimension_;
    int threads_;
    Level tiles_, supers_, blocks_;  ///< of the blocks, only weights are used
    LaneBuffer values_;              ///< tiles × d × 16
    std::vector<float> squared_;     ///< of each row, to the nearest centre
};

/// The j-th draw of a restart has a stream of its own, so that a start can be redone alone.
RandomStream draw_stream(uint64_t seed, int restart, int64_t draw) {
    constexpr uint64_t draws_per_restart = uint64_t{1} << 32;
    return {seed, "k-means++",
            static_cast<uint64_t>(restart) * draws_per_restart + static_cast<uint64_t>(draw)};
}

Mixture equal_clusters(const std::vector<std::vector<float>>& centres, double variance) {
    const auto count = static_cast<int64_t>(centres.size());
    const auto dimension = static_cast<int64_t>(centres.front().size());
    Mixture mixture{MatrixD(count, dimension), VectorD::Constant(count, variance),
                    VectorD::Constant(count, 1.0 / static_cast<double>(count))};
    for (int64_t k = 0; k < count; ++k) {
        for (int64_t j = 0; j < dimension; ++j) {
            mixture.means(k, j) = double(centres[size_t(k)][size_t(j)]);
        }
    }
    return mixture;
}

}  // namespace

Mixture start_mixture(const MatrixFView& rows, const PieceLayout& layout, int64_t clusters,
                      const MixtureOptions& options, int restart, int threads) {
    require_layout_of(rows, layout);
    require_finite(rows);
    if (clusters < 1 || rows.rows() < clusters || rows.cols() < 1) {
        throw std::invalid_argument(std::to_string(clusters) + " clusters cannot be started from " +
                                    std::to_string(rows.rows()) + " rows of " +
                                    std::to_string(rows.cols()) + " columns");
    }
    const int64_t count = std::min(rows.rows(), std::max(options.start_sample, clusters));
    StartSample sample(rows, count, threads);
    const auto first = draw_stream(options.seed, restart, 0).below(static_cast<uint64_t>(count));
    std::vector<std::vector<float>> centres{sample.row(static_cast<int64_t>(first))};
    sample.add_centre(centres.back());
    for (int64_t draw = 1; draw < clusters; ++draw) {
        const double total = sample.total_weight();
        if (!(total > 0)) break;
        const double target = draw_stream(options.seed, restart, draw).uniform() * total;
        centres.push_back(sample.row(sample.row_at(target)));
        sample.add_centre(centres.back());
    }
    const double left =
        sample.total_weight() / static_cast<double>(count) / static_cast<double>(rows.cols());
    const double floor = least_variance(moments_of(rows, layout, threads), options);
    return equal_clusters(centres, std::max(left, floor));
}

}  // namespace kinetome
