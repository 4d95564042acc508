#include "repetition_cuts.h"

#include <algorithm>
#include <limits>

namespace kinetome {
namespace {

/// What recurs in [a, end) for every a, `end` growing frame by frame.
class RecurringWeight {
  public:
    explicit RecurringWeight(const Recurrence& recurrence)
        : recurrence_(recurrence), from_(static_cast<size_t>(recurrence.size()), 0.0) {}

    /// Takes in the next frame: [a, end) gains twice what the frame has with those since a.
    void extend() {
        const auto frames = recurrence_.frames_of(end_);
        const auto weights = recurrence_.weights_of(end_);
        const auto earlier = std::ranges::lower_bound(frames, end_) - frames.begin();
        double gain = 0;
        auto counted = from_.begin() + end_;
        for (auto e = static_cast<size_t>(earlier); e-- > 0;) {
            const auto next = from_.begin() + frames[e] + 1;
            std::for_each(next, counted, [gain](double& weight) { weight += gain; });
            counted = next;
            gain += 2 * weights[e];
        }
        std::for_each(from_.begin(), counted, [gain](double& weight) { weight += gain; });
        ++end_;
    }
    double from(int64_t first) const { return from_[static_cast<size_t>(first)]; }

  private:
    const Recurrence& recurrence_;
    std::vector<double> from_;
    int64_t end_ = 0;
};

/// How the frames before some end are cut best.
struct BestCut {
    double score = -std::numeric_limits<double>::infinity();
    ScoredSegment last;
};

}  // namespace

std::vector<ScoredSegment> repetition_cuts(const Recurrence& recurrence, double segment_cost) {
    RecurringWeight weight(recurrence);
    std::vector<BestCut> best{{0, {}}};
    for (int64_t end = 1; end <= recurrence.size(); ++end) {
        weight.extend();
        BestCut& cut = best.emplace_back();
        for (int64_t first = 0; first < end; ++first) {
            const double repetitions = weight.from(first) / double(end - first);
            const double score =
                best[static_cast<size_t>(first)].score + repetitions - segment_cost;
            if (score > cut.score) cut = {score, {{first, end}, repetitions}};
        }
    }
    std::vector<ScoredSegment> segments;
    for (int64_t end = recurrence.size(); end > 0; end = segments.back().frames.first) {
        segments.push_back(best[static_cast<size_t>(end)].last);
    }
    std::ranges::reverse(segments);
    return segments;
}

}  // namespace kinetome
