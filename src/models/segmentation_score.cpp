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

std::map<int32_t, FramesByClass> counts_of_clusters(std::span<const Segment> segments,
                                                    const std::vector<FramesByClass>& counts) {
    std::map<int32_t, FramesByClass> clusters;
    for (size_t s = 0; s < segments.size(); ++s) {
        if (segments[s].kind == SegmentKind::transition) continue;
        const auto [found, is_new] = clusters.try_emplace(segments[s].cluster, counts[s]);
        if (!is_new) found->second += counts[s];
    }
    return clusters;
}

double share(int64_t part, int64_t whole) {
    return whole > 0 ? double(part) / double(whole) : 0.0;
}

/// Frames of a cluster by class, as a scored figure counts them.
using Counted = ClassCounts (*)(const FramesByClass&);

ClassCounts all_frames(const FramesByClass& frames) {
    return frames.outside_zones + frames.inside_zones;
}

ClassCounts certain_frames(const FramesByClass& frames) {
    return frames.outside_zones;
}

/// The class given to each cluster, one to one, such that most of the counted frames agree.
std::vector<int32_t> give_classes(const std::map<int32_t, FramesByClass>& clusters,
                                  const Counted& counted) {
    if (clusters.empty()) return {};
    const auto size = static_cast<Eigen::Index>(clusters.size());
    MatrixD agreeing(size, clusters.begin()->second.outside_zones.size());
    Eigen::Index row = 0;
    for (const auto& [cluster, frames] : clusters) {
        agreeing.row(row++) = counted(frames).cast<double>().matrix().transpose();
    }
    return best_assignment(agreeing);
}

int64_t frames_of_given_class(const std::map<int32_t, FramesByClass>& clusters,
                              const Counted& counted) {
    const std::vector<int32_t> given = give_classes(clusters, counted);
    int64_t right = 0;
    auto its_class = given.begin();
    for (const auto& [cluster, frames] : clusters) {
        if (*its_class >= 0) right += counted(frames)[*its_class];
        ++its_class;
    }
    return right;
}

/// Between each activity and the next: a transition, or a place without frames.
std::vector<RowRange> boundaries_of(std::span<const Segment> segments) {
    std::vector<RowRange> boundaries;
    const Segment* before = nullptr;
    for (const Segment& segment : segments) {
        if (segment.kind == SegmentKind::transition) continue;
        if (before) boundaries.push_back({before->frames.end, segment.frames.first});
        before = &segment;
    }
    return boundaries;
}

/// Both ascend in their beginnings and in their ends, so that taking the first that fits finds
/// most.
int64_t zones_found(std::span<const RowRange> zones, std::span<const RowRange> boundaries,
                    double tolerance) {
    int64_t found = 0;
    size_t zone = 0, boundary = 0;
    while (zone < zones.size() && boundary < boundaries.size()) {
        const RowRange& allowed = zones[zone];
        const RowRange& set = boundaries[boundary];
        if (double(set.end) < double(allowed.first) - tolerance) {
            ++boundary;
        } else if (double(set.first) > double(allowed.end) + tolerance) {
            ++zone;
        } else {
            ++found;
            ++zone;
            ++boundary;
        }
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

void score_clusters(const std::map<int32_t, FramesByClass>& clusters, int64_t frames,
                    int64_t certain, SegmentationScore& score) {
    int64_t pure = 0, certain_in_activities = 0;
    for (const auto& [cluster, of_cluster] : clusters) {
        pure += of_cluster.of_own_class();
        certain_in_activities += of_cluster.certain();
    }
    score.cluster_purity = share(pure, certain_in_activities);
    score.hungarian = share(frames_of_given_class(clusters, all_frames), frames);
    score.hungarian_without_zones = share(frames_of_given_class(clusters, certain_frames), certain);
}

void score_boundaries(const TruthTimeline& truth, std::span<const Segment> segments,
                      double tolerance, SegmentationScore& score) {
    const std::vector<RowRange> boundaries = boundaries_of(segments);
    const int64_t found = zones_found(truth.zones, boundaries, tolerance);
    SegmentationCounts& counts = score.counts;
    counts.boundaries = static_cast<int64_t>(boundaries.size());
    counts.true_boundaries = static_cast<int64_t>(truth.zones.size());
    counts.boundaries_found = found;
    score.boundary_precision = boundaries.empty() ? 1.0 : share(found, counts.boundaries);
    score.boundary_recall = truth.zones.empty() ? 1.0 : share(found, counts.true_boundaries);
}

}  // namespace

SegmentationScore score_segments(const TruthTimeline& truth, std::span<const Segment> segments,
                                 const SegmentationScoreOptions& options) {
    require_cover(truth, segments);
    SegmentationScore score;
    if (segments.empty()) return score;
    const std::vector<FramesByClass> counts = count_frames(truth, segments);
    const auto clusters = counts_of_clusters(segments, counts);
    int64_t certain = 0;
    for (const FramesByClass& segment : counts) certain += segment.certain();
    score.counts = count_segments(truth, segments, clusters.size());
    score_frames(segments, counts, truth.frames(), score);
    score_clusters(clusters, truth.frames(), certain, score);
    score_boundaries(truth, segments, options.boundary_tolerance * options.rate, score);
    return score;
}

std::vector<std::pair<int32_t, int32_t>> classes_of_clusters(const TruthTimeline& truth,
                                                             std::span<const Segment> segments) {
    require_cover(truth, segments);
    const auto clusters = counts_of_clusters(segments, count_frames(truth, segments));
    const std::vector<int32_t> given = give_classes(clusters, certain_frames);
    std::vector<std::pair<int32_t, int32_t>> classes;
    for (const auto& [cluster, frames] : clusters) {
        const int32_t its_class = given[classes.size()];
        const bool agrees = its_class >= 0 && frames.outside_zones[its_class] > 0;
        classes.emplace_back(cluster, agrees ? its_class : -1);
    }
    return classes;
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
        mean.counts.boundaries += score.counts.boundaries;
        mean.counts.true_boundaries += score.counts.true_boundaries;
        mean.counts.boundaries_found += score.counts.boundaries_found;
    }
    return mean;
}

}  // namespace kinetome
