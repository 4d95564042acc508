#include "boundaries.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "frame_count.h"
#include "kinetome/math/quantiles.h"
#include "path_costs.h"

namespace kinetome {
namespace {

using CostRow = Eigen::Ref<const RowVectorF>;

/// The cost from one frame to the likest of `columns` that is `away` or more frames from it, which
/// some are.
double least_cost(const CostRow& costs, int64_t frame, const RowRange& columns, int64_t away) {
    const int64_t before = std::min(columns.end, frame - away + 1) - columns.first;
    const int64_t after = columns.end - std::max(columns.first, frame + away);
    float least = std::numeric_limits<float>::infinity();
    if (before > 0) least = costs.segment(columns.first, before).minCoeff();
    if (after > 0) least = std::min(least, costs.segment(columns.end - after, after).minCoeff());
    return double(least);
}

/// How unlike an activity each of some frames is: the negative logarithm of an exponential density
/// whose scale is what its own frames have in the median.
struct Unlikeness {
    RowRange activity;
    int64_t away = 0;
    std::vector<double> of_frames = {};  ///< path costs at first

    Unlikeness(const RowRange& frames, int64_t least_return)
        : activity(frames), away(std::min(least_return, frames.size() / 3)) {}

    void add(int64_t frame, const CostRow& costs) {
        of_frames.push_back(least_cost(costs, frame, activity, away));
    }
    void scale_by_own(double least_scale) {
        const auto first = of_frames.begin();
        const double own = upper_median<double>({first + activity.first, first + activity.end});
        const double scale = std::max(own, least_scale);
        for (double& value : of_frames) value = value / scale + std::log(scale);
    }
};

/// The boundary with the least sum of unlikeness, at most `reach` frames inside either activity.
int64_t best_boundary(const Unlikeness& left, const Unlikeness& right, int64_t reach) {
    const int64_t first = left.activity.end - std::min(reach, left.activity.size() / 3);
    const int64_t last = right.activity.first + std::min(reach, right.activity.size() / 3);
    double sum = 0, least = 0;
    int64_t best = first;
    for (int64_t frame = first; frame < last; ++frame) {
        sum += left.of_frames[size_t(frame)] - right.of_frames[size_t(frame)];
        if (sum < least) {
            least = sum;
            best = frame + 1;
        }
    }
    return best;
}

}  // namespace

int64_t likeliest_boundary(const RowRange& before, const RowRange& after,
                           const MatrixFView& features, const RepetitionOptions& options,
                           double rate) {
    const int64_t least_return = frame_count(options.least_return, rate);
    Unlikeness left({0, before.size()}, least_return);
    Unlikeness right({after.first - before.first, after.end - before.first}, least_return);
    for_each_cost_row({features, {before.first, after.end}}, frame_count(options.path_side, rate),
                      [&](int64_t frame, const auto& costs) {
                          left.add(frame, costs);
                          right.add(frame, costs);
                      });
    left.scale_by_own(options.transition_floor);
    right.scale_by_own(options.transition_floor);
    return before.first + best_boundary(left, right, frame_count(options.boundary_reach, rate));
}

void refine_boundaries(std::span<Segment> segments, const MatrixFView& features,
                       const RepetitionOptions& options, double rate) {
    for (size_t s = 0; s + 1 < segments.size(); ++s) {
        if (segments[s].kind != SegmentKind::activity) continue;
        if (segments[s + 1].kind != SegmentKind::activity) continue;
        RowRange& before = segments[s].frames;
        RowRange& after = segments[s + 1].frames;
        before.end = after.first = likeliest_boundary(before, after, features, options, rate);
    }
}

}  // namespace kinetome
