#include "kinetome/models/activity.h"

#include <stdexcept>

#include "boundaries.h"
#include "foreign_parts.h"
#include "frame_count.h"
#include "recurrence.h"
#include "region_growing.h"
#include "repetition_cuts.h"
#include "sameness.h"
#include "transitions.h"

namespace kinetome {
namespace {

/// What does not repeat and is short is a transition, if it lies between others.
std::vector<Segment> repetitive_segments(const Recurrence& recurrence,
                                         const RepetitionOptions& options, double rate,
                                         int64_t longest_transition) {
    std::vector<Segment> segments;
    const auto cuts = without_foreign_parts(repetition_cuts(recurrence, options.segment_cost),
                                            recurrence, options, rate);
    for (const auto& [frames, repetitions] : cuts) {
        const bool is_between = frames.first > 0 && frames.end < recurrence.size();
        const bool is_transition = is_between && repetitions < options.least_repetition &&
                                   frames.size() < longest_transition;
        segments.push_back(
            {frames, is_transition ? SegmentKind::transition : SegmentKind::activity, -1});
    }
    return segments;
}

std::vector<Segment> repetitive_activities(const NeighborGraph& graph, const MatrixFView& features,
                                           const RepetitionOptions& options, double rate,
                                           int64_t longest_transition) {
    const Recurrence recurring =
        recurrence(within(graph, options.radius), frame_count(options.longest_hold, rate));
    const std::vector<Segment> activities =
        joined_activities(repetitive_segments(recurring, options, rate, longest_transition),
                          recurring, options.least_sameness);
    std::vector<Segment> segments =
        with_transitions(activities, features, recurring, options, rate);
    refine_boundaries(segments, features, options, rate);
    return segments;
}

}  // namespace

std::vector<Segment> find_activities(const NeighborGraph& graph, const MatrixFView& features,
                                     const ActivityOptions& options) {
    if (features.rows() != graph.frames()) {
        throw std::invalid_argument("activities: the graph is of another take than the features");
    }
    if (!(options.rate > 0)) throw std::invalid_argument("activities: the rate is not positive");
    if (graph.frames() == 0) return {};

    const int64_t longest_transition = frame_count(options.longest_transition, options.rate);
    return options.method == ActivityMethod::region_growing
               ? grown_regions(within(graph, options.region_growing.radius), options.region_growing,
                               options.rate, longest_transition)
               : repetitive_activities(graph, features, options.repetition, options.rate,
                                       longest_transition);
}

}  // namespace kinetome
