#include "sameness.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinetome/base/matrix.h"

namespace kinetome {
namespace {

constexpr auto is_activity = [](const Segment& segment) {
    return segment.kind == SegmentKind::activity;
};

std::vector<int32_t> segment_of_frames(std::span<const Segment> segments) {
    std::vector<int32_t> numbers;
    for (size_t s = 0; s < segments.size(); ++s) {
        numbers.insert(numbers.end(), static_cast<size_t>(segments[s].frames.size()),
                       static_cast<int32_t>(s));
    }
    return numbers;
}

/// Mean weight of a frame of one segment with a frame of another, for each pair of segments; of a
/// frame with itself, 1.
MatrixD density(std::span<const Segment> segments, const Recurrence& recurrence) {
    const auto count = static_cast<int64_t>(segments.size());
    const std::vector<int32_t> segment_of = segment_of_frames(segments);
    MatrixD sums = MatrixD::Zero(count, count);
    for (int64_t i = 0; i < recurrence.size(); ++i) {
        const auto frames = recurrence.frames_of(i);
        const auto weights = recurrence.weights_of(i);
        for (size_t e = 0; e < frames.size(); ++e) {
            sums(segment_of[size_t(i)], segment_of[size_t(frames[e])]) += weights[e];
        }
    }
    VectorD lengths(count);
    for (int64_t s = 0; s < count; ++s) lengths[s] = double(segments[size_t(s)].frames.size());
    sums.diagonal() += lengths;
    return sums.array() / (lengths * lengths.transpose()).array();
}

}  // namespace

void cluster_activities(std::span<Segment> segments, const Recurrence& recurrence,
                        double least_sameness) {
    const MatrixD dense = density(segments, recurrence);
    const auto same = [&](int64_t x, int64_t y) {
        return dense(x, y) >= least_sameness * std::sqrt(dense(x, x) * dense(y, y));
    };
    int32_t clusters = 0;
    for (Segment& segment : segments) segment.cluster = -1;
    for (size_t first = 0; first < segments.size(); ++first) {
        if (!is_activity(segments[first]) || segments[first].cluster >= 0) continue;
        segments[first].cluster = clusters++;
        std::vector<size_t> reached{first};
        while (!reached.empty()) {
            const size_t from = reached.back();
            reached.pop_back();
            for (size_t to = first + 1; to < segments.size(); ++to) {
                Segment& segment = segments[to];
                if (!is_activity(segment) || segment.cluster >= 0) continue;
                if (!same(static_cast<int64_t>(from), static_cast<int64_t>(to))) continue;
                segment.cluster = segments[first].cluster;
                reached.push_back(to);
            }
        }
    }
}

std::vector<Segment> joined_activities(std::vector<Segment> segments, const Recurrence& recurrence,
                                       double least_sameness) {
    for (size_t before = segments.size() + 1; segments.size() < before;) {
        before = segments.size();
        cluster_activities(segments, recurrence, least_sameness);
        std::vector<Segment> joined;
        for (const Segment& segment : segments) {
            const bool goes_on =
                !joined.empty() && is_activity(segment) && joined.back().cluster == segment.cluster;
            if (goes_on) {
                joined.back().frames.end = segment.frames.end;
            } else {
                joined.push_back(segment);
            }
        }
        segments = std::move(joined);
    }
    return segments;
}

}  // namespace kinetome
