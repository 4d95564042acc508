#include "transitions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "boundaries.h"
#include "frame_count.h"
#include "frame_distances.h"
#include "kinetome/math/quantiles.h"

namespace kinetome {
namespace {

/// For each frame of an activity, how far the nearest other one is that is `away` or more frames
/// from it.
std::vector<float> return_distances(const FrameDistances& activity, double away) {
    const int64_t frames = activity.size();
    const auto skipped = static_cast<int64_t>(std::ceil(away));
    std::vector<float> nearest;
    RowVectorF distances(frames);
    for (int64_t i = 0; i < frames; ++i) {
        activity.from(i, distances);
        float least = std::numeric_limits<float>::infinity();
        if (i >= skipped) least = distances.head(i - skipped + 1).minCoeff();
        if (i + skipped < frames) {
            least = std::min(least, distances.tail(frames - i - skipped).minCoeff());
        }
        nearest.push_back(least);
    }
    return nearest;
}

/// Frames at the beginning of a series that are unlike the rest of it: the prefix in which strange
/// ones most outweigh usual ones.
template <class Iterator>
int64_t strange_prefix(Iterator first, int64_t longest, double threshold) {
    constexpr double usual_weighs = 1.5;
    double score = 0, best = 0;
    int64_t length = 0;
    for (int64_t i = 0; i < longest; ++i, ++first) {
        score += double(*first) > threshold ? 1 : -usual_weighs;
        if (score > best) {
            best = score;
            length = i + 1;
        }
    }
    return length;
}

/// Frames that a transition takes from an activity, where it begins and where it ends.
struct Sides {
    int64_t head = 0, tail = 0;
};

Sides strange_sides(const RowRange& activity, const MatrixFView& features,
                    const Recurrence& recurrence, const RepetitionOptions& options, double rate) {
    const std::vector<int32_t> holds(recurrence.hold.begin() + activity.first,
                                     recurrence.hold.begin() + activity.end);
    const double away = std::min(std::max(options.least_return * rate, double(upper_median(holds))),
                                 double(activity.size()) / 3);
    const std::vector<float> distances = return_distances({features, activity}, away);
    const double threshold = std::max(options.transition_floor,
                                      options.transition_ratio * double(upper_median(distances)));
    const int64_t longest = std::min(frame_count(options.longest_side, rate), activity.size() / 3);
    return {strange_prefix(distances.begin(), longest, threshold),
            strange_prefix(distances.rbegin(), longest, threshold)};
}

}  // namespace

std::vector<Segment> with_transitions(const std::vector<Segment>& segments,
                                      const MatrixFView& features, const Recurrence& recurrence,
                                      const RepetitionOptions& options, double rate) {
    std::vector<Sides> sides;
    for (const Segment& segment : segments) {
        sides.push_back(segment.kind == SegmentKind::activity
                            ? strange_sides(segment.frames, features, recurrence, options, rate)
                            : Sides{});
    }
    const int64_t shortest = frame_count(options.least_transition, rate);
    std::vector<Segment> result;
    for (size_t s = 0; s < segments.size(); ++s) {
        Segment segment = segments[s];
        const bool after_activity = s > 0 && segments[s - 1].kind == SegmentKind::activity;
        if (after_activity && segment.kind == SegmentKind::activity &&
            sides[s - 1].tail + sides[s].head >= shortest) {
            RowRange& before = result.back().frames;
            RowRange& after = segment.frames;
            before.end -= sides[s - 1].tail;
            after.first += sides[s].head;
            const RowRange between{before.end, after.first};
            const int64_t boundary = likeliest_boundary(before, after, features, options, rate);
            if (boundary >= between.first && boundary <= between.end) {
                result.push_back({between, SegmentKind::transition, -1});
            } else {
                before.end = after.first = boundary;
            }
        }
        result.push_back(segment);
    }
    return result;
}

}  // namespace kinetome
