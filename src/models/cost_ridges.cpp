#include "cost_ridges.h"

#include <algorithm>
#include <utility>

#include "frame_count.h"
#include "kinetome/math/quantiles.h"
#include "movement_period.h"
#include "share_executed.h"

namespace kinetome {
namespace {

constexpr int deepest_search = 3;
constexpr double longest_shift = 0.9;  // periods

/// When a frame recurs; frames and cm.
struct RidgeRule {
    double radius = 0;
    double least_ridge = 0;
    double ridge_share = 0;
    int64_t least_spacing = 0;
    int64_t side = 0;
};

/// The frames at which the movement of one frame recurs.
struct Repetitions {
    std::vector<int64_t> frames;  ///< ascending, the frame itself among them
    double clarity = 0;           ///< sum of how far the cost rises from one to the next
};

using CostRow = Eigen::Ref<const RowVectorF>;

/// Whether the cost rises enough between a repetition that is chosen and a minimum.
bool ridge_between(const CostRow& costs, int64_t chosen, int64_t minimum, const RidgeRule& rule) {
    const auto [first, last] = std::minmax(chosen, minimum);
    const double top = double(costs.segment(first, last - first + 1).maxCoeff());
    return last - first >= rule.least_spacing &&
           top - double(costs[minimum]) >= std::max(rule.least_ridge, rule.ridge_share * top);
}

/// Nearest first.
std::vector<int64_t> minima_of(const CostRow& costs, double radius) {
    // At the first or last frame the true minimum may lie outside.
    std::vector<int64_t> minima;
    for (int64_t j = 1; j + 1 < costs.size(); ++j) {
        const bool is_minimum = costs[j] < costs[j - 1] && costs[j] <= costs[j + 1];
        if (is_minimum && double(costs[j]) < radius) minima.push_back(j);
    }
    std::ranges::stable_sort(minima, {}, [&](int64_t j) { return costs[j]; });
    return minima;
}

Repetitions repetitions_of(int64_t frame, const CostRow& costs, const RidgeRule& rule) {
    Repetitions found{{frame}, 0};
    for (const int64_t j : minima_of(costs, rule.radius)) {
        const auto after = std::ranges::upper_bound(found.frames, j);
        const bool apart =
            (after == found.frames.end() || ridge_between(costs, *after, j, rule)) &&
            (after == found.frames.begin() || ridge_between(costs, *(after - 1), j, rule));
        if (!apart) continue;
        found.frames.insert(after, j);
    }
    // The cost itself is least where the movement pauses: those frames recur well, but not on time.
    for (size_t r = 1; r < found.frames.size(); ++r) {
        const int64_t one = found.frames[r - 1], next = found.frames[r];
        const float top = costs.segment(one, next - one + 1).maxCoeff();
        found.clarity += double(top - std::max(costs[one], costs[next]));
    }
    return found;
}

/// Those of the frame whose movement recurs most, and most clearly; none when none recurs. Frames
/// near the ends are not asked: their paths are cut short there, and pauses resemble them.
std::vector<int64_t> clearest_repetitions(const FrameDistances& activity, const RidgeRule& rule) {
    Repetitions clearest;
    const int64_t margin = std::min(rule.side, activity.size() / 4);
    for_each_cost_row(activity, rule.side, [&](int64_t i, const auto& costs) {
        if (i < margin || i >= activity.size() - margin) return;
        Repetitions found = repetitions_of(i, costs, rule);
        if (found.clarity > clearest.clarity) clearest = std::move(found);
    });
    return clearest.frames;
}

double median_spacing(const std::vector<int64_t>& frames) {
    std::vector<int64_t> spacings;
    for (size_t i = 1; i < frames.size(); ++i) spacings.push_back(frames[i] - frames[i - 1]);
    return double(upper_median(std::move(spacings)));
}

/// Cuts a stretch where its movement begins anew.
class StretchCutter {
  public:
    StretchCutter(const MatrixFView& features, const PrimitiveOptions& options)
        : features_(features),
          options_(options.cost_ridges),
          shortest_(frame_count(options.shortest, options.rate)),
          side_(frame_count(options.cost_ridges.path_side, options.rate)) {}

    /// From the activity's first frame to the end of its last primitive.
    std::vector<int64_t> cuts(const RowRange& activity) const {
        std::vector<int64_t> found = starts(activity, shortest_, 0);
        if (!breaks_off(activity, found)) found.push_back(activity.end);
        return found;
    }

  private:
    /// Ascending from the stretch's first frame. `spacing` is the least between two.
    std::vector<int64_t> starts(const RowRange& stretch, int64_t spacing, int depth) const {
        const FrameDistances distances(features_, stretch);
        const MovementPeriod known = movement_period(
            distances, {shortest_, side_, options_.least_dip, options_.dip_of_deepest});
        std::vector<int64_t> found = clearest_repetitions(distances, rule_for(known, spacing));
        if (found.empty()) return {stretch.first};
        for (int64_t& frame : found) frame += stretch.first;
        const double period = known.frames > 0 ? double(known.frames) : median_spacing(found);
        if (double(found.front() - stretch.first) > longest_shift * period) {
            found.insert(found.begin(), stretch.first);
        }
        if (depth < deepest_search) found = with_gaps_cut(found, stretch.end, period, depth);
        move_to(stretch.first, found);
        if (!ends_take(stretch) && leaves_little(stretch, found, period)) found.pop_back();
        return found;
    }

    /// Whether what begins last is too little of the movement to stand by itself. It may last for
    /// long all the same: in the pose that the movement ends with, which is like its first.
    bool leaves_little(const RowRange& stretch, const std::vector<int64_t>& starts,
                       double period) const {
        const double lasts = double(stretch.end - starts.back()) / period;
        return lasts < options_.least_piece ||
               (starts.size() > 1 && executed(stretch, starts) < options_.least_piece);
    }

    bool ends_take(const RowRange& stretch) const { return stretch.end == features_.rows(); }

    /// Whether the end of the take cuts off what began last. Where a movement gives way to another
    /// it is taken to be complete: when that happens cannot be told so exactly.
    bool breaks_off(const RowRange& activity, const std::vector<int64_t>& starts) const {
        return starts.size() > 1 && ends_take(activity) &&
               executed(activity, starts) < options_.least_executed;
    }

    /// The share of the movement, begun at the last of at least two starts, that the stretch holds.
    double executed(const RowRange& stretch, std::vector<int64_t> starts) const {
        for (int64_t& frame : starts) frame -= stretch.first;
        return share_executed({features_, stretch}, starts, side_);
    }

    RidgeRule rule_for(const MovementPeriod& known, int64_t spacing) const {
        RidgeRule rule{options_.radius, options_.least_ridge, options_.ridge_share, spacing, side_};
        if (known.frames > 0) {
            // Whose mean cost is hardly lower a period apart cannot have higher ridges.
            rule.ridge_share = std::min(options_.periodic_ridge_share, known.dip);
            rule.least_spacing = frame_count(options_.least_spacing, double(known.frames));
        }
        return rule;
    }

    /// A movement whose extent drifts may recur only in a stretch of its own.
    std::vector<int64_t> with_gaps_cut(const std::vector<int64_t>& found, int64_t end,
                                       double period, int depth) const {
        const int64_t spacing = std::max(shortest_, frame_count(options_.least_piece, period));
        std::vector<int64_t> all;
        for (size_t i = 0; i < found.size(); ++i) {
            const RowRange gap{found[i], i + 1 < found.size() ? found[i + 1] : end};
            if (double(gap.size()) > options_.longest_gap * period) {
                std::ranges::copy(starts(gap, spacing, depth + 1), std::back_inserter(all));
            } else {
                all.push_back(gap.first);
            }
        }
        return all;
    }

    /// All are shifted, so that the first cycle begins where the stretch does.
    static void move_to(int64_t first, std::vector<int64_t>& frames) {
        const int64_t shift = frames.front() - first;
        for (int64_t& frame : frames) frame -= shift;
    }

    const MatrixFView& features_;
    const CostRidgeOptions& options_;
    int64_t shortest_, side_;
};

}  // namespace

std::vector<int64_t> cost_ridge_cuts(const MatrixFView& features, const RowRange& activity,
                                     const PrimitiveOptions& options) {
    return StretchCutter(features, options).cuts(activity);
}

}  // namespace kinetome
