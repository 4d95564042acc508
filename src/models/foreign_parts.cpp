#include "foreign_parts.h"

#include <algorithm>
#include <optional>

#include "frame_count.h"

namespace kinetome {
namespace {

/// Weight between the frames of a segment.
struct WeightInside {
    std::vector<double> earlier, later;  ///< of each frame, with those before it and after it
    double total = 0;

    WeightInside(const RowRange& segment, const Recurrence& recurrence) {
        for (int64_t i = segment.first; i < segment.end; ++i) {
            const auto frames = recurrence.frames_of(i);
            const auto weights = recurrence.weights_of(i);
            double before = 0, after = 0;
            for (size_t e = 0; e < frames.size(); ++e) {
                if (frames[e] < segment.first || frames[e] >= segment.end) continue;
                (frames[e] < i ? before : after) += weights[e];
            }
            earlier.push_back(before);
            later.push_back(after);
            total += before + after;
        }
    }
};

struct Part {
    double frames = 0;
    double weight = 0;  ///< between its frames

    double repetitions() const { return weight / frames; }
    double cycles() const { return 1 + repetitions(); }
};

struct Parting {
    int64_t frame = 0;
    double met = 0;  ///< in how many of its cycles either part meets the other's frames, at most
    Part before, after;
};

/// The cut of a segment across which its parts, of which one repeats, meet least.
std::optional<Parting> least_met(const RowRange& segment, const Recurrence& recurrence,
                                 int64_t shortest) {
    constexpr double repeated = 2;
    if (segment.size() < 2 * shortest) return {};
    const WeightInside inside(segment, recurrence);
    std::optional<Parting> best;
    double weight_before = 0, across = 0;
    for (int64_t length = 1; length <= segment.size() - shortest; ++length) {
        const auto last = static_cast<size_t>(length - 1);
        weight_before += 2 * inside.earlier[last];
        across += inside.later[last] - inside.earlier[last];
        if (length < shortest) continue;
        const Part before{double(length), weight_before};
        const Part after{double(segment.size() - length),
                         std::max(inside.total - weight_before - 2 * across, 0.0)};
        if (std::max(before.cycles(), after.cycles()) < repeated) continue;
        const double met = std::max(across / before.frames / after.cycles(),
                                    across / after.frames / before.cycles());
        if (!best || met < best->met) best = {segment.first + length, met, before, after};
    }
    return best;
}

}  // namespace

std::vector<ScoredSegment> without_foreign_parts(const std::vector<ScoredSegment>& segments,
                                                 const Recurrence& recurrence,
                                                 const RepetitionOptions& options, double rate) {
    const int64_t shortest = std::max<int64_t>(frame_count(options.least_part, rate), 1);
    std::vector<ScoredSegment> result;
    std::vector<ScoredSegment> left(segments.rbegin(), segments.rend());
    while (!left.empty()) {
        const ScoredSegment segment = left.back();
        left.pop_back();
        const auto parting = least_met(segment.frames, recurrence, shortest);
        if (!parting || parting->met >= options.foreign) {
            result.push_back(segment);
            continue;
        }
        left.push_back({{parting->frame, segment.frames.end}, parting->after.repetitions()});
        left.push_back({{segment.frames.first, parting->frame}, parting->before.repetitions()});
    }
    return result;
}

}  // namespace kinetome
