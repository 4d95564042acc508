#include "kinetome/models/activity.h"

#include <stdexcept>

#include "frame_count.h"
#include "recurrence.h"
#include "region_growing.h"
#include "repetition_cuts.h"
#include "sameness.h"
#include "transitions.h"

namespace kinetome {
namespace {

std::vector<Segment> repetitive_segments(const Recurrence& recurrence,
                                         const RepetitionOptions& options,
                                         int64_t longest_transition) {
    std::vector<Segment> segments;
    for (const ScoredSegment& found : repetition_cuts(recurrence, options.segment_cost)) {
        const bool is_transition = found.repetitions < options.least_repetition &&
                                   found.frames.size() < longest_transition;
        segments.push_back(
            {found.frames, is_transition ? SegmentKind::transition : SegmentKind::activity, -1});
    }
    return segments;
}

std::vector<Segment> repetitive_activities(const NeighborGraph& graph, const MatrixFView& features,
                                           const RepetitionOptions& options, double rate,
                                           int64_t longest_transition) {
    const Recurrence recurring =
        recurrence(within(graph, options.radius), frame_count(options.longest_hold, rate));
    const std::vector<Segment> activities =
        joined_activities(repetitive_segments(recurring, options, longest_transition), recurring,
                          options.least_sameness);
    return with_transitions(activities, features, recurring, options, rate);
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
