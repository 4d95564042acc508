// The activities of a take (S3 §3.1): stretches in which a movement repeats, or one that stands
// alone, and the transitions between them.
#pragma once

#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/neighbor_graph.h"
#include "kinetome/models/segment.h"

namespace kinetome {

enum class ActivityMethod {
    repetition,      ///< the cuts with which frames recur most inside segments; exact
    region_growing,  ///< S3 as written: a segment grows while new neighbours appear
};

/// Times are seconds, distances those of the features (cm).
struct RegionGrowingOptions {
    double radius = 64;           ///< longer edges of the graph do not count
    double patience = 1.0 / 30;   ///< a region is complete after so long without new neighbours
    double least_spacing = 1;     ///< cuts nearer to each other become one, halfway
    double least_gap = 8.0 / 30;  ///< the same where a region ends and the next one starts
};

/// Times are seconds, distances those of the features (cm).
struct RepetitionOptions {
    double radius = 72;             ///< longer edges of the graph do not count
    double longest_hold = 4.0 / 3;  ///< frames that stay similar to one for up to so long before
                                    ///< and after it do not repeat it
    double segment_cost = 0.3;      ///< repetitions that one segment more must bring
    double foreign = 0.1;   ///< parts of a segment that meet in fewer of their cycles are two …
    double least_part = 1;  ///< … if both last as long as this
    double least_repetition = 0.5;    ///< of an activity that is no longer than a transition
    double least_sameness = 2.0 / 3;  ///< from which two activities are the same; 1 is what the
                                      ///< halves of one activity have
    double transition_ratio = 1.5;  ///< a frame of a transition is farther from the activity than …
    double transition_floor = 15;   ///< … this and so many times as far as the activity's median
    double least_return = 2.0 / 3;  ///< frames nearer in time do not count for that
    double longest_side = 1;        ///< of a transition, before its boundary and after
    double least_transition = 0.2;  ///< shorter ones are left to their activities
    double boundary_reach = 1.0 / 3;  ///< that a boundary or a transition's end is moved at most
    double path_side = 8.0 / 30;      ///< of the warping paths by which frames are compared for it
};

struct ActivityOptions {
    ActivityMethod method = ActivityMethod::repetition;
    double rate = 30;               ///< of the features, frames a second
    double longest_transition = 2;  ///< s; what does not repeat for longer is an activity
    RegionGrowingOptions region_growing;
    RepetitionOptions repetition;
};

/// Cuts a take into activities and transitions, which follow each other without gaps. `features`
/// are its n × d rows, `graph` is their neighbourhood graph, of a radius no less than the method's.
/// Activities of one cluster are the same one, clusters being numbered as they appear; with
/// region_growing each is a cluster of its own (S3 §4 lets clusters of primitives tell what is the
/// same). No segments for a take without frames. Throws std::invalid_argument when graph and
/// features have not the same frames, or the rate is not positive.
std::vector<Segment> find_activities(const NeighborGraph& graph, const MatrixFView& features,
                                     const ActivityOptions& options = {});

}  // namespace kinetome
