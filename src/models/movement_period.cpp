#include "movement_period.h"

#include <algorithm>
#include <vector>

namespace kinetome {
namespace {

/// The mean path cost of frames so far apart, for each lag.
VectorD mean_cost_at_lags(const FrameDistances& activity, int64_t side) {
    const int64_t frames = activity.size();
    VectorD sums = VectorD::Zero(frames);
    for_each_cost_row(activity, side, [&](int64_t i, const auto& costs) {
        sums.head(frames - i) += costs.tail(frames - i).transpose().template cast<double>();
    });
    for (int64_t lag = 0; lag < frames; ++lag) sums[lag] /= double(frames - lag);
    return sums;
}

/// Lags at which the mean cost is less than at those beside them.
std::vector<MovementPeriod> dips_of(const VectorD& costs, int64_t shortest) {
    // With more, fewer than half as many frames as the lag has are left to tell.
    const int64_t longest = std::min(2 * costs.size() / 3, costs.size() - 2);
    std::vector<MovementPeriod> dips;
    double top = 0;
    for (int64_t lag = 1; lag <= longest; ++lag) {
        top = std::max(top, costs[lag]);
        const bool is_least = costs[lag] < costs[lag - 1] && costs[lag] <= costs[lag + 1];
        if (lag >= shortest && is_least) dips.push_back({lag, 1 - costs[lag] / top});
    }
    return dips;
}

}  // namespace

MovementPeriod movement_period(const FrameDistances& activity, const PeriodRule& rule) {
    const auto dips = dips_of(mean_cost_at_lags(activity, rule.side), rule.shortest);
    double least = rule.least_dip;
    for (const auto& [lag, dip] : dips) least = std::max(least, rule.same_dip * dip);
    const auto found =
        std::ranges::find_if(dips, [&](const auto& period) { return period.dip >= least; });
    return found == dips.end() ? MovementPeriod() : *found;
}

}  // namespace kinetome
