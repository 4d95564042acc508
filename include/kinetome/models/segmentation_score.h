// How well a take's segments agree with its annotation (S3 §5.1), frame by frame and boundary by
// boundary.
//
// The first five figures ask whether a segment is of one class, so that cutting a take into many
// short pieces suffices for high ones: read them beside the counts, the boundaries and the
// Hungarian figures, and beside what the controls of segmentation_controls.h reach.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "kinetome/models/segment.h"
#include "kinetome/models/truth_timeline.h"

namespace kinetome {

struct SegmentationCounts {
    int64_t frames = 0;
    int64_t activities = 0, true_activities = 0;
    int64_t clusters = 0, classes = 0;
    int64_t transitions = 0, transition_frames = 0;
    int64_t boundaries = 0, true_boundaries = 0, boundaries_found = 0;
    bool operator==(const SegmentationCounts&) const = default;
};

/// Shares in [0, 1]. Zones are the frames whose class is uncertain; the class of a segment or a
/// cluster is that of most of its frames outside zones.
struct SegmentationScore {
    /// Frames of activities are right outside zones if they have their segment's class; frames of
    /// transitions inside zones.
    double strict = 0;
    /// Frames inside zones are right, the others if they have the class of their segment,
    /// transitions too.
    double tolerant = 0;
    double lenient = 0;  ///< as tolerant, and every frame of a transition is right
    /// Of the activities' frames outside zones, those that have the class of their segment.
    double purity = 0;
    double cluster_purity = 0;  ///< ... of their cluster
    /// Frames that have the one class that is given to their cluster, no class to two clusters, in
    /// the way that makes most frames right; frames of transitions are wrong.
    double hungarian = 0;
    double hungarian_without_zones = 0;  ///< as hungarian, of the frames outside zones
    /// Boundaries between two activities that lie in a zone or near it, each zone taken once; of a
    /// transition between them one end suffices. 1 where no boundary was set.
    double boundary_precision = 0;
    double boundary_recall = 0;  ///< zones that a boundary lies in or near; 1 where there is none
    SegmentationCounts counts;
};

struct SegmentationScoreOptions {
    double rate = 120;                ///< frames a second, of truth and segments
    double boundary_tolerance = 0.5;  ///< seconds by which a boundary may miss a zone
};

/// `segments` count frames as `truth` does. Throws std::invalid_argument unless they follow each
/// other from frame 0 to the truth's end, and activities have clusters.
SegmentationScore score_segments(const TruthTimeline& truth, std::span<const Segment> segments,
                                 const SegmentationScoreOptions& options = {});

/// The class given to each cluster of the segments, clusters in ascending order: no class to two,
/// such that most frames outside zones have the class of their cluster; -1 where none is left that
/// any of the cluster's frames have.
std::vector<std::pair<int32_t, int32_t>> classes_of_clusters(const TruthTimeline& truth,
                                                             std::span<const Segment> segments);

/// The mean of the shares and the sum of the counts; of none, zeros.
SegmentationScore average(std::span<const SegmentationScore> scores);

}  // namespace kinetome
