// Motion primitives (S3 §3.2): the single executions of the movement that an activity repeats.
#pragma once

#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/neighbor_graph.h"
#include "kinetome/models/segment.h"

namespace kinetome {

enum class PrimitiveMethod {
    cost_ridges,    ///< repetitions of the frame that repeats most clearly; palindromes do no harm
    warping_paths,  ///< S3 as written: one path through each component of the activity's graph
};

/// Times are seconds, distances those of the features (cm).
struct CostRidgeOptions {
    double radius = 72;           ///< a repetition is nearer than this, on the mean along its path
    double path_side = 8.0 / 30;  ///< that a path extends to either side of the pair it is for
    double least_ridge = 1.5;     ///< by so much the cost rises between two repetitions, and by …
    double ridge_share = 0.35;  ///< … this share of its top, where the activity has no period, or …
    double periodic_ridge_share = 0.2;  ///< … by this where it has one, but by no more than
                                        ///< the mean cost dips by a period apart
    double least_dip = 0.05;  ///< a period is the shortest lag at which the mean cost dips by this
                              ///< share of its top at shorter lags, and by …
    double dip_of_deepest = 0.3;  ///< … this share of what its deepest dip has
    double least_spacing = 0.75;  ///< periods between two repetitions
    double longest_gap = 1.6;     ///< periods; a longer stretch is searched by itself
    double least_piece = 0.4;  ///< periods; what is left at the end, if shorter, or if it executes
                               ///< less of the movement than this, joins the last
    double least_executed = 0.95;  ///< share of a movement that the end of the take cuts off, from
                                   ///< which it counts as a primitive
};

/// Times are seconds, distances those of the features (cm).
struct WarpingPathOptions {
    double radius = 64;   ///< longer edges do not count
    double steepest = 2;  ///< mean slope of a path, or its reciprocal, at most
    double least_symmetry =
        0.5;  ///< share of a path's cells that are in the graph mirrored as well
};

struct PrimitiveOptions {
    PrimitiveMethod method = PrimitiveMethod::cost_ridges;
    double rate = 30;            ///< of the features, frames a second
    double shortest = 5.0 / 30;  ///< of a primitive and of a path
    CostRidgeOptions cost_ridges;
    WarpingPathOptions warping_paths;
};

/// The primitives of each activity, in order, without gaps inside it: an activity in which nothing
/// recurs is one primitive. Transitions have none; nor (by cost_ridges) has what an activity begins
/// anew and has not completed when the take ends. `features` are the n × d rows of the take,
/// `graph` is their neighbourhood graph, `segments` its activities (find_activities). Throws
/// std::invalid_argument when these do not fit together, or the rate is not positive.
std::vector<Primitive> find_primitives(const MatrixFView& features, const NeighborGraph& graph,
                                       std::span<const Segment> segments,
                                       const PrimitiveOptions& options = {});

}  // namespace kinetome
