#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "candidate_search.h"
#include "frame_super.h"
#include "kinetome/base/piece_sum.h"
#include "kinetome/math/mixture.h"
#include "lanes.h"
#include "mixture_input.h"

namespace kinetome {
namespace {

// Responsibilities are left out only where they add up to less than this at a frame.
constexpr double left_out = 1e-7;

constexpr int64_t vectors_per_tile = tile_rows / lane_count;

/// The clusters some frame of a super belongs to: their means about its centre and their sums.
/// Floats suffice, because at most 256 frames are added before they go to the double sums.
class TouchedClusters {
  public:
    TouchedClusters(const ClusterDensities& densities, int64_t stride)
        : densities_(densities),
          stride_(stride),
          slots_(static_cast<size_t>(densities.clusters()), -1) {}

    /// The slot of a cluster, made when it is touched first.
    int64_t touch(int32_t cluster, std::span<const float> centre) {
        int32_t& slot = slots_[static_cast<size_t>(cluster)];
        if (slot < 0) {
            slot = static_cast<int32_t>(clusters_.size());
            clusters_.push_back(cluster);
            make_room(clusters_.size());
            for (size_t j = 0; j < centre.size(); ++j) {
                mean(slot)[j] =
                    static_cast<float>(densities_.means(cluster, int64_t(j)) - double(centre[j]));
            }
        }
        return slot;
    }

    float* mean(int64_t slot) { return means_.data() + slot * stride_; }
    float* offset(int64_t slot) { return offsets_.data() + slot * stride_; }  ///< Σ r (y - μ)
    float* responsibility(int64_t slot) { return lane(responsibilities_, slot); }  ///< 16 × Σ r
    float* squared(int64_t slot) { return lane(squares_, slot); }  ///< 16 × Σ r |y - μ|²

    /// Adds everything to the sums and forgets it.
    void flush(MixtureSums& sums) {
        for (size_t slot = 0; slot < clusters_.size(); ++slot) {
            const int32_t cluster = clusters_[slot];
            const auto index = static_cast<int64_t>(slot);
            sums.responsibility[cluster] += sum_of_lanes(responsibility(index));
            sums.squared[cluster] += sum_of_lanes(squared(index));
            for (int64_t j = 0; j < densities_.dimension(); ++j) {
                sums.offset(cluster, j) += double(offset(index)[j]);
            }
            slots_[static_cast<size_t>(cluster)] = -1;
        }
        clusters_.clear();
        for (LaneBuffer* buffer : {&means_, &offsets_, &responsibilities_, &squares_}) {
            buffer->clear();
        }
    }

  private:
    static float* lane(LaneBuffer& buffer, int64_t slot) {
        return buffer.data() + slot * tile_rows;
    }

    void make_room(size_t count) {
        means_.resize(count * static_cast<size_t>(stride_));
        offsets_.resize(means_.size());
        responsibilities_.resize(count * tile_rows);
        squares_.resize(responsibilities_.size());
    }

    static double sum_of_lanes(const float* lanes) {
        double sum = 0;
        for (int64_t i = 0; i < tile_rows; ++i) sum += double(lanes[i]);
        return sum;
    }

    const ClusterDensities& densities_;
    int64_t stride_;
    std::vector<int32_t> slots_;  ///< of each cluster, -1 where untouched
    std::vector<int32_t> clusters_;
    LaneBuffer means_, offsets_, responsibilities_, squares_;
};

/// E step over the rows of one piece.
class PieceExpectation {
  public:
    PieceExpectation(const ClusterDensities& densities, const ClusterGroups& groups)
        : densities_(densities),
          frames_(densities.dimension()),
          search_(groups, within(densities.clusters())),
          touched_(densities, frames_.row_stride()) {
        sums_.responsibility.setZero(densities.clusters());
        sums_.offset.setZero(densities.clusters(), densities.dimension());
        sums_.squared.setZero(densities.clusters());
    }

    /// `first_row` is the number of the first of these rows, for messages.
    MixtureSums run(const MatrixFView& rows, int64_t first_row) {
        for (int64_t first = 0; first < rows.rows(); first += super_rows) {
            frames_.load(rows, {first, std::min(first + super_rows, rows.rows())}, first_row);
            search_.run(frames_);
            for (int64_t tile = 0; tile < frames_.tiles(); ++tile) add_tile(tile);
            touched_.flush(sums_);
        }
        sums_.rows = rows.rows();
        return std::move(sums_);
    }

  private:
    static float within(int64_t clusters) {
        return static_cast<float>(std::log(static_cast<double>(clusters) / left_out));
    }

    void add_tile(int64_t tile) {
        find_densities(tile);
        find_responsibilities(tile);
        for (size_t i = 0; i < slots_.size(); ++i) add_candidate(tile, i);
    }

    float* density(size_t candidate) { return densities_at_.data() + candidate * tile_rows; }
    float* squared(size_t candidate) { return squared_.data() + candidate * tile_rows; }

    /// ln density and |y - μ|² of every candidate at every frame, and the largest density of each.
    void find_densities(int64_t tile) {
        const auto candidates = search_.candidates(tile);
        slots_.clear();
        for (const int32_t cluster : candidates) {
            slots_.push_back(touched_.touch(cluster, frames_.centre()));
        }
        densities_at_.resize(slots_.size() * tile_rows);
        squared_.resize(densities_at_.size());
        for (auto& lanes : largest_) lanes = all_lanes(std::numeric_limits<float>::lowest());
        for (size_t i = 0; i < slots_.size(); ++i) {
            const auto cluster = static_cast<size_t>(candidates[i]);
            const auto offset = static_cast<float>(densities_.offsets[cluster]);
            const auto slope = static_cast<float>(densities_.slopes[cluster]);
            for (int64_t v = 0; v < vectors_per_tile; ++v) {
                const Lanes distance =
                    squared_distance(frames_.tile(tile) + v * lane_count, touched_.mean(slots_[i]));
                const Lanes value = larger(slope * distance + offset,
                                           all_lanes(std::numeric_limits<float>::lowest()));
                store_lanes(distance, squared(i) + v * lane_count);
                store_lanes(value, density(i) + v * lane_count);
                largest_[v] = larger(value, largest_[v]);
            }
        }
    }

    Lanes squared_distance(const float* frames, const float* mean) const {
        Lanes sum{};
        for (int64_t j = 0; j < densities_.dimension(); ++j) {
            const Lanes difference = load_lanes(frames + j * strip_rows) - mean[j];
            sum += difference * difference;
        }
        return sum;
    }

    /// Densities become responsibilities (S1, E step); rows that fill the last tile have none.
    void find_responsibilities(int64_t tile) {
        const int64_t frames = std::min(tile_rows, frames_.size() - tile * tile_rows);
        for (int64_t v = 0; v < vectors_per_tile; ++v) {
            Lanes total{};
            for (size_t i = 0; i < slots_.size(); ++i) {
                const Lanes value =
                    exponential(load_lanes(density(i) + v * lane_count) - largest_[v]);
                store_lanes(value, density(i) + v * lane_count);
                total += value;
            }
            Lanes factor;
            for (int64_t lane = 0; lane < lane_count; ++lane) {
                const bool filled = v * lane_count + lane < frames;
                factor[lane] = filled ? 1 / total[lane] : 0.0F;
                if (filled) {
                    sums_.log_likelihood +=
                        double(largest_[v][lane]) + std::log(double(total[lane]));
                }
            }
            for (size_t i = 0; i < slots_.size(); ++i) {
                float* const value = density(i) + v * lane_count;
                store_lanes(load_lanes(value) * factor, value);
            }
        }
    }

    void add_candidate(int64_t tile, size_t candidate) {
        const float* const responsibility = density(candidate);
        const int64_t slot = slots_[candidate];
        for (int64_t first = 0; first < tile_rows; first += lane_count) {
            const Lanes share = load_lanes(responsibility + first);
            float* const sum = touched_.responsibility(slot) + first;
            float* const spread = touched_.squared(slot) + first;
            store_lanes(load_lanes(sum) + share, sum);
            store_lanes(load_lanes(spread) + share * load_lanes(squared(candidate) + first),
                        spread);
        }
        const int64_t stride = frames_.row_stride();
        for (int64_t j = 0; j < stride; j += lane_count) {
            const float* row = frames_.row(tile * tile_rows) + j;
            const Lanes mean = load_lanes(touched_.mean(slot) + j);
            Lanes sum = load_lanes(touched_.offset(slot) + j);
            for (int64_t i = 0; i < tile_rows; ++i, row += stride) {
                sum += responsibility[i] * (load_lanes(row) - mean);
            }
            store_lanes(sum, touched_.offset(slot) + j);
        }
    }

    const ClusterDensities& densities_;
    FrameSuper frames_;
    CandidateSearch search_;
    TouchedClusters touched_;
    MixtureSums sums_;
    // Of the tile at hand: candidates × 16.
    std::vector<int64_t> slots_;
    LaneBuffer densities_at_, squared_;
    Lanes largest_[vectors_per_tile];
};

}  // namespace

MixtureSums accumulate(const Mixture& model, const RowSource& rows, const Workers& workers) {
    require_dimension_of(rows.columns(), model.dimension());
    const ClusterDensities densities(model, true);
    const ClusterGroups groups(densities);
    const auto sums_of = [&](const MatrixFView& piece, int64_t first_row) {
        return PieceExpectation(densities, groups).run(piece, first_row);
    };
    auto sums = sum_pieces<MixtureSums>(
        workers, rows.layout(),
        [&](const RowRange& piece) { return sums_of(rows.read(piece).view(), piece.first); },
        [](MixtureSums& left, const MixtureSums& right) { merge(left, right); });
    return sums ? *std::move(sums) : sums_of(MatrixF(0, rows.columns()), 0);
}

}  // namespace kinetome
