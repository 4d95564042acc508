#include "kinetome/models/segmentation_score.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <vector>

#include "kinetome/math/assignment.h"

namespace kinetome {
namespace {

using ClassCounts = Eigen::Array<int64_t, Eigen::Dynamic, 1>;

/// Frames of a segment or a cluster by their true class.
struct FramesByClass {
    ClassCounts outside_zones, inside_zones;

    explicit FramesByClass(size_t classes = 0)
        : outside_zones(ClassCounts::Zero(static_cast<Eigen::Index>(classes))),
          inside_zones(ClassCounts::Zero(static_cast<Eigen::Index>(classes))) {}

    FramesByClass& operator+=(const FramesByClass& other) {
        outside_zones += other.outside_zones;
        inside_zones += other.inside_zones;
        return *this;
    }
    int64_t of_own_class() const { return outside_zones.maxCoeff(); }
    int64_t uncertain() const { return inside_zones.sum(); }
    int64_t certain() const { return outside_zones.sum(); }
};

void require_cover(const TruthTimeline& truth, std::span<const Segment> segments) {
    int64_t end = 0;
    for (const Segment& segment : segments) {
        if (segment.frames.first != end || segment.frames.end <= segment.frames.first) {
            throw std::invalid_argument("the segments of a take do not follow each other");
        }
        if (segment.kind == SegmentKind::activity && segment.cluster < 0) {
            throw std::invalid_argument("an activity has no cluster");
        }
        end = segment.frames.end;
    }
    if (end != truth.frames()) {
        throw std::invalid_argument("segments end at frame " + std::to_string(end) +
                                    ", the annotation at " + std::to_string(truth.frames()));
    }
}

std::vector<FramesByClass> count_frames(const TruthTimeline& truth,
                                        std::span<const Segment> segments) {
    const std::vector<int32_t> labels = truth.class_of_frames();
    const std::vector<char> uncertain = truth.uncertain_frames();
    std::vector<FramesByClass> counts;
    for (const Segment& segment : segments) {
        FramesByClass frames(truth.classes.size());
        for (int64_t f = segment.frames.first; f < segment.frames.end; ++f) {
            const auto frame = static_cast<size_t>(f);
            ++(uncertain[frame] ? frames.inside_zones : frames.outside_zones)[labels[frame]];
        }
        counts.push_back(std::move(frames));
    }
    return counts;
}

std::vector<FramesByClass> counts_of_clusters(std::span<const Segment> segments,
                                              const std::vector<FramesByClass>& counts) {
    std::map<int32_t, FramesByClass> clusters;
    for (size_t s = 0; s < segments.size(); ++s) {
        if (segments[s].kind == SegmentKind::transition) continue;
        const auto [found, is_new] = clusters.try_emplace(segments[s].cluster, counts[s]);
        if (!is_new) found->second += counts[s];
    }
    std::vector<FramesByClass> in_order;
    for (auto& [cluster, frames] : clusters) in_order.push_back(std::move(frames));
    return in_order;
}

double share(int64_t part, int64_t whole) {
    return whole > 0 ? double(part) / double(whole) : 0.0;
}

/// Frames that have the class given to their cluster, at best.
template <class Frames>
int64_t frames_of_given_class(const std::vector<FramesByClass>& clusters, const Frames& frames_of) {
    if (clusters.empty()) return 0;
    MatrixD agreeing(clusters.size(), clusters.front().outside_zones.size());
    for (size_t c = 0; c < clusters.size(); ++c) {
        agreeing.row(static_cast<int64_t>(c)) =
            frames_of(clusters[c]).template cast<double>().matrix().transpose();
    }
    const std::vector<int32_t> given = best_assignment(agreeing);
    int64_t right = 0;
    for (size_t c = 0; c < clusters.size(); ++c) {
        if (given[c] >= 0) right += frames_of(clusters[c])[given[c]];
    }
    return right;
}

/// Between each activity and the next; twice the frame, so that the middle of a transition is a
/// whole number.
std::vector<int64_t> doubled_boundaries(std::span<const Segment> segments) {
    std::vector<int64_t> boundaries;
    const Segment* before = nullptr;
    for (const Segment& segment : segments) {
        if (segment.kind == SegmentKind::transition) continue;
        if (before) boundaries.push_back(before->frames.end + segment.frames.first);
        before = &segment;
    }
    return boundaries;
}

/// Zones and boundaries ascend, so taking the earliest boundary for each zone finds most.
int64_t zones_found(const TruthTimeline& truth, const std::vector<int64_t>& boundaries,
                    double tolerance) {
    int64_t found = 0;
    auto next = boundaries.begin();
    for (const RowRange& zone : truth.zones) {
        const auto is_before = [&](int64_t doubled) {
            return double(doubled) < 2 * (double(zone.first) - tolerance);
        };
        next = std::find_if_not(next, boundaries.end(), is_before);
        if (next == boundaries.end()) break;
        if (double(*next) > 2 * (double(zone.end) + tolerance)) continue;
        ++found;
        ++next;
    }
    return found;
}

SegmentationCounts count_segments(const TruthTimeline& truth, std::span<const Segment> segments,
                                  size_t clusters) {
    SegmentationCounts counts;
    counts.frames = truth.frames();
    counts.true_activities = static_cast<int64_t>(truth.activities.size());
    counts.classes = static_cast<int64_t>(truth.classes.size());
    counts.clusters = static_cast<int64_t>(clusters);
    for (const Segment& segment : segments) {
        const bool is_transition = segment.kind == SegmentKind::transition;
        ++(is_transition ? counts.transitions : counts.activities);
        if (is_transition) counts.transition_frames += segment.frames.size();
    }
    return counts;
}

void score_frames(std::span<const Segment> segments, const std::vector<FramesByClass>& counts,
                  int64_t frames, SegmentationScore& score) {
    int64_t strict = 0, tolerant = 0, lenient = 0, pure = 0, certain_in_activities = 0;
    for (size_t s = 0; s < segments.size(); ++s) {
        const FramesByClass& segment = counts[s];
        const int64_t own = segment.of_own_class();
        tolerant += own + segment.uncertain();
        if (segments[s].kind == SegmentKind::transition) {
            strict += segment.uncertain();
            lenient += segments[s].frames.size();
        } else {
            strict += own;
            lenient += own + segment.uncertain();
            pure += own;
            certain_in_activities += segment.certain();
        }
    }
    score.strict = share(strict, frames);
    score.tolerant = share(tolerant, frames);
    score.lenient = share(lenient, frames);
    score.purity = share(pure, certain_in_activities);
}

void score_clusters(const std::vector<FramesByClass>& clusters, int64_t frames,
                    int64_t certain_frames, SegmentationScore& score) {
    int64_t pure = 0, certain_in_activities = 0;
    for (const FramesByClass& cluster : clusters) {
        pure += cluster.of_own_class();
        certain_in_activities += cluster.certain();
    }
    score.cluster_purity = share(pure, certain_in_activities);
    const auto all = [](const FramesByClass& c) -> ClassCounts {
        return c.outside_zones + c.inside_zones;
    };
    const auto certain = [](const FramesByClass& c) { return c.outside_zones; };
    score.hungarian = share(frames_of_given_class(clusters, all), frames);
    score.hungarian_without_zones = share(frames_of_given_class(clusters, certain), certain_frames);
}

void score_boundaries(const TruthTimeline& truth, std::span<const Segment> segments,
                      double tolerance, SegmentationScore& score) {
    const std::vector<int64_t> boundaries = doubled_boundaries(segments);
    const int64_t found = zones_found(truth, boundaries, tolerance);
    const auto set = static_cast<int64_t>(boundaries.size());
    const auto true_ones = static_cast<int64_t>(truth.zones.size());
    score.boundary_precision = set > 0 ? share(found, set) : 1.0;
    score.boundary_recall = true_ones > 0 ? share(found, true_ones) : 1.0;
}

}  // namespace

SegmentationScore score_segments(const TruthTimeline& truth, std::span<const Segment> segments,
                                 const SegmentationScoreOptions& options) {
    require_cover(truth, segments);
    SegmentationScore score;
    if (segments.empty()) return score;
    const std::vector<FramesByClass> counts = count_frames(truth, segments);
    const std::vector<FramesByClass> clusters = counts_of_clusters(segments, counts);
    int64_t certain = 0;
    for (const FramesByClass& segment : counts) certain += segment.certain();
    score.counts = count_segments(truth, segments, clusters.size());
    score_frames(segments, counts, truth.frames(), score);
    score_clusters(clusters, truth.frames(), certain, score);
    score_boundaries(truth, segments, options.boundary_tolerance * options.rate, score);
    return score;
}

SegmentationScore average(std::span<const SegmentationScore> scores) {
    SegmentationScore mean;
    if (scores.empty()) return mean;
    const auto take_mean_of = [&](double SegmentationScore::*share) {
        for (const SegmentationScore& score : scores) mean.*share += score.*share;
        mean.*share /= double(scores.size());
    };
    take_mean_of(&SegmentationScore::strict);
    take_mean_of(&SegmentationScore::tolerant);
    take_mean_of(&SegmentationScore::lenient);
    take_mean_of(&SegmentationScore::purity);
    take_mean_of(&SegmentationScore::cluster_purity);
    take_mean_of(&SegmentationScore::hungarian);
    take_mean_of(&SegmentationScore::hungarian_without_zones);
    take_mean_of(&SegmentationScore::boundary_precision);
    take_mean_of(&SegmentationScore::boundary_recall);
    for (const SegmentationScore& score : scores) {
        mean.counts.frames += score.counts.frames;
        mean.counts.activities += score.counts.activities;
        mean.counts.true_activities += score.counts.true_activities;
        mean.counts.clusters += score.counts.clusters;
        mean.counts.classes += score.counts.classes;
        mean.counts.transitions += score.counts.transitions;
        mean.counts.transition_frames += score.counts.transition_frames;
    }
    return mean;
}

}  // namespace kinetome
