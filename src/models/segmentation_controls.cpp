#include "kinetome/models/segmentation_controls.h"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace kinetome {
namespace {

/// Cuts ascend; the first and last are the take's ends.
std::vector<Segment> activities_between(const std::vector<int64_t>& cuts) {
    std::vector<Segment> segments;
    for (size_t i = 0; i + 1 < cuts.size(); ++i) {
        segments.push_back(
            {{cuts[i], cuts[i + 1]}, SegmentKind::activity, static_cast<int32_t>(i)});
    }
    return segments;
}

void require_count(int64_t frames, int64_t count) {
    if (count < 1 || count > frames) {
        throw std::invalid_argument("cannot cut " + std::to_string(frames) + " frames into " +
                                    std::to_string(count) + " activities");
    }
}

}  // namespace

std::vector<Segment> cuts_every(int64_t frames, int64_t length) {
    if (length < 1) throw std::invalid_argument("activities need at least one frame");
    std::vector<int64_t> cuts;
    for (int64_t cut = 0; cut < frames; cut += length) cuts.push_back(cut);
    cuts.push_back(frames);
    return activities_between(cuts);
}

std::vector<Segment> uniform_cuts(int64_t frames, int64_t count) {
    require_count(frames, count);
    std::vector<int64_t> cuts;
    for (int64_t i = 0; i <= count; ++i) cuts.push_back(i * frames / count);
    return activities_between(cuts);
}

std::vector<Segment> random_cuts(int64_t frames, int64_t count, RandomStream& random) {
    require_count(frames, count);
    std::set<int64_t> cuts = {0, frames};
    while (static_cast<int64_t>(cuts.size()) < count + 1) {
        cuts.insert(1 + static_cast<int64_t>(random.below(static_cast<uint64_t>(frames) - 1)));
    }
    return activities_between({cuts.begin(), cuts.end()});
}

std::vector<Segment> segments_of(const TruthTimeline& truth) {
    std::vector<Segment> segments;
    for (const TrueActivity& activity : truth.activities) {
        segments.push_back({activity.frames, SegmentKind::activity, activity.label});
    }
    return segments;
}

}  // namespace kinetome
