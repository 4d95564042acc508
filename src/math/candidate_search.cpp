#include "candidate_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>

namespace kinetome {
namespace {

constexpr int group_size = ClusterGroups::group_size;
constexpr int group_stride = ClusterGroups::group_stride;

// Packed rows of so many groups stay in the first-level cache while all frames of a super pass.
constexpr int64_t groups_at_once = 16;

constexpr float rounding = std::numeric_limits<float>::epsilon() / 2;

/// The rounding error of a density by expanded products is at most
///     2 (d + 4) u (3 |offset| + 2 |density| + 8 |slope| |y|²),
/// because the terms' magnitudes add up to |offset| + |slope| (|μ| + |y|)² and |μ| <= |y| + |y -
/// μ|. It counts twice: for the largest density and for the one compared with it.
float error_factor(int64_t dimension) {
    return 4 * (static_cast<float>(dimension) + 4) * rounding;
}

using GroupDensities = Lanes[group_size][strip_vectors];

/// Densities of six clusters at the frames of a strip: fused multiply-adds over the dimensions.
inline void evaluate(const float* frames, const float* packed, int64_t dimension,
                     GroupDensities& density) {
    const float* const constants = packed + (dimension + 1) * group_stride;
    Lanes sums[group_size][strip_vectors];
    for (int c = 0; c < group_size; ++c) {
        for (int v = 0; v < strip_vectors; ++v) sums[c][v] = all_lanes(constants[c]);
    }
    for (int64_t j = 0; j <= dimension; ++j) {
        Lanes frame[strip_vectors];
        for (int v = 0; v < strip_vectors; ++v) {
            frame[v] = load_lanes(frames + j * strip_rows + v * lane_count);
        }
        for (int c = 0; c < group_size; ++c) {
            const float factor = packed[j * group_stride + c];
            for (int v = 0; v < strip_vectors; ++v) sums[c][v] += factor * frame[v];
        }
    }
    for (int c = 0; c < group_size; ++c) {
        for (int v = 0; v < strip_vectors; ++v) density[c][v] = sums[c][v];
    }
}

void check(const Mixture& mixture) {
    if (mixture.clusters() < 1 || mixture.variances.size() != mixture.clusters() ||
        mixture.weights.size() != mixture.clusters()) {
        throw std::invalid_argument("a mixture needs as many variances and weights as means");
    }
    for (int64_t k = 0; k < mixture.clusters(); ++k) {
        const double variance = mixture.variances[k], weight = mixture.weights[k];
        if (!(variance > 0 && weight > 0 && std::isfinite(variance) && std::isfinite(weight))) {
            throw std::invalid_argument("cluster " + std::to_string(k) +
                                        " needs a positive variance and a positive weight");
        }
    }
}

}  // namespace

ClusterDensities::ClusterDensities(const Mixture& mixture, bool weighted) : means(mixture.means) {
    check(mixture);
    const auto half_dimension = 0.5 * static_cast<double>(mixture.dimension());
    for (int64_t k = 0; k < mixture.clusters(); ++k) {
        const double variance = mixture.variances[k];
        offsets.push_back((weighted ? std::log(mixture.weights[k]) : 0.0) -
                          half_dimension * std::log(2 * std::numbers::pi * variance));
        slopes.push_back(-0.5 / variance);
    }
}

ClusterGroups::ClusterGroups(const ClusterDensities& densities)
    : dimension_(densities.dimension()),
      clusters_(densities.clusters()),
      count_((densities.clusters() + group_size - 1) / group_size),
      high_(static_cast<size_t>(count_ * dimension_ * group_stride)),
      low_(high_.size()),
      slopes_(static_cast<size_t>(count_ * group_stride)),
      offsets_(slopes_.size(), -std::numeric_limits<float>::infinity()) {
    for (int64_t k = 0; k < densities.clusters(); ++k) {
        const int64_t group = k / group_size, entry = k % group_size;
        for (int64_t j = 0; j < dimension_; ++j) {
            const auto place = static_cast<size_t>((group * dimension_ + j) * group_stride + entry);
            high_[place] = static_cast<float>(densities.means(k, j));
            low_[place] = static_cast<float>(densities.means(k, j) - double(high_[place]));
        }
        const auto place = static_cast<size_t>(group * group_stride + entry);
        slopes_[place] = static_cast<float>(densities.slopes[size_t(k)]);
        offsets_[place] = static_cast<float>(densities.offsets[size_t(k)]);
        largest_slope_ = std::max(largest_slope_, std::abs(slopes_[place]));
        largest_offset_ = std::max(largest_offset_, std::abs(offsets_[place]));
    }
}

void ClusterGroups::pack(int64_t group, std::span<const float> centre, float* packed) const {
    using Entries = float __attribute__((vector_size(group_stride * sizeof(float))));
    const auto load = [](const float* from) {
        Entries entries;
        std::memcpy(&entries, from, sizeof entries);
        return entries;
    };
    const auto store = [](const Entries& entries, float* to) {
        std::memcpy(to, &entries, sizeof entries);
    };
    const float* const high = high_.data() + group * dimension_ * group_stride;
    const float* const low = low_.data() + group * dimension_ * group_stride;
    const Entries slope = load(slopes_.data() + group * group_stride);
    const Entries twice_slope = -2 * slope;
    Entries square{};
    for (int64_t j = 0; j < dimension_; ++j) {
        const Entries mean =
            (load(high + j * group_stride) - centre[size_t(j)]) + load(low + j * group_stride);
        square += mean * mean;
        store(twice_slope * mean, packed + j * group_stride);
    }
    store(slope, packed + dimension_ * group_stride);
    store(load(offsets_.data() + group * group_stride) + slope * square,
          packed + (dimension_ + 1) * group_stride);
}

CandidateSearch::CandidateSearch(const ClusterGroups& groups, float within)
    : groups_(groups),
      dimension_(groups.dimension()),
      within_(within),
      packed_(static_cast<size_t>(groups_at_once * groups.packed_size())),
      bars_(static_cast<size_t>(super_rows / strip_rows)),
      candidates_(static_cast<size_t>(super_rows / tile_rows)) {}

void CandidateSearch::run(const FrameSuper& frames) {
    reset(frames);
    for (int64_t first = 0; first < groups_.count(); first += groups_at_once) {
        const int64_t count = std::min(groups_at_once, groups_.count() - first);
        for (int64_t g = 0; g < count; ++g) {
            groups_.pack(first + g, frames.centre(), packed_.data() + g * groups_.packed_size());
        }
        for (int64_t strip = 0; strip < frames.strips(); ++strip) {
            scan_strip(frames, strip, first, count);
        }
    }
    list_all_where_products_overflow(frames);
}

void CandidateSearch::reset(const FrameSuper& frames) {
    const Lanes nothing = all_lanes(-std::numeric_limits<float>::infinity());
    for (int64_t strip = 0; strip < frames.strips(); ++strip) {
        Bar& bar = bars_[static_cast<size_t>(strip)];
        for (int v = 0; v < strip_vectors; ++v) bar.largest[v] = bar.least[v] = nothing;
        bar.below = within_ + error_factor(dimension_) *
                                  (3 * groups_.largest_offset() + 2 * within_ +
                                   8 * groups_.largest_slope() * frames.largest_square(strip));
    }
    for (auto& list : candidates_) list.clear();
}

void CandidateSearch::scan_strip(const FrameSuper& frames, int64_t strip, int64_t first_group,
                                 int64_t group_count) {
    const Bar& bar = bars_[static_cast<size_t>(strip)];
    for (int64_t g = 0; g < group_count; ++g) {
        GroupDensities density;
        evaluate(frames.strip(strip), packed_.data() + g * groups_.packed_size(), dimension_,
                 density);
        bool found = false;
        for (int v = 0; v < strip_vectors; ++v) {
            Lanes largest = density[0][v];
            for (int c = 1; c < group_size; ++c) largest = larger(density[c][v], largest);
            found |= any_greater(largest, bar.least[v]);
        }
        if (found) [[unlikely]]
            list_candidates(strip, first_group + g, density);
    }
}

void CandidateSearch::list_candidates(int64_t strip, int64_t group, const GroupDensities& density) {
    Bar& bar = bars_[static_cast<size_t>(strip)];
    const float of_magnitude = 2 * error_factor(dimension_);
    for (int v = 0; v < strip_vectors; ++v) {
        for (int c = 0; c < group_size; ++c) {
            bar.largest[v] = larger(density[c][v], bar.largest[v]);
        }
        const Lanes magnitude = larger(bar.largest[v], -bar.largest[v]);
        bar.least[v] = bar.largest[v] - bar.below - of_magnitude * magnitude;
    }
    constexpr int vectors_per_tile = tile_rows / lane_count;
    for (int v = 0; v < strip_vectors; v += vectors_per_tile) {
        const int64_t tile = (strip * strip_rows + v * lane_count) / tile_rows;
        for (int c = 0; c < group_size; ++c) {
            bool above = false;
            for (int i = v; i < v + vectors_per_tile; ++i) {
                above |= any_greater(density[c][i], bar.least[i]);
            }
            if (above) {
                candidates_[static_cast<size_t>(tile)].push_back(
                    static_cast<int32_t>(group * group_size + c));
            }
        }
    }
}

void CandidateSearch::list_all_where_products_overflow(const FrameSuper& frames) {
    constexpr int64_t vectors_per_tile = tile_rows / lane_count;
    const Lanes nothing = all_lanes(-std::numeric_limits<float>::infinity());
    for (int64_t tile = 0; tile < frames.tiles(); ++tile) {
        const int64_t first = tile * tile_rows;
        const Bar& bar = bars_[static_cast<size_t>(first / strip_rows)];
        bool found = std::isfinite(bar.below);
        for (int64_t i = 0; i < vectors_per_tile; ++i) {
            found &= all_greater(bar.largest[first % strip_rows / lane_count + i], nothing);
        }
        if (found) continue;
        auto& list = candidates_[static_cast<size_t>(tile)];
        list.resize(static_cast<size_t>(groups_.clusters()));
        std::iota(list.begin(), list.end(), 0);
    }
}

}  // namespace kinetome
