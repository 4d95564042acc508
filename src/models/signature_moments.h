// What a motion is compared by when it is compared moment by moment.
#pragma once

#include <cstdint>
#include <span>

#include "kinetome/models/placed_signature.h"
#include "kinetome/models/signature_match.h"

namespace kinetome {

/// A motion that queries are compared with, or a query.
struct MotionView {
    std::span<const SignatureRun> runs;
    MatrixFView positions;  ///< of the runs
    FrameSamples samples;
    MatrixFView sample_positions;
};

MotionView view_of(const PlacedSignature& signature);

/// Moments `spacing` frames apart.
struct Moments {
    double first = 0, spacing = 1;  ///< frames
    int64_t count = 0;
};

/// Between positions (n × r and m × r), n × m.
MatrixF distances_between(const MatrixFView& query, const MatrixFView& text);

/// n × m distances between moments of two motions, mm per marker. A moment lies where the mean pose
/// of its run does, so that it matters little which moments of a run are compared, but in a run
/// longer than `longest` frames where its own pose does.
MatrixF distances_between(const MotionView& query, const Moments& of_query, const MotionView& text,
                          const Moments& of_text, int64_t longest);

/// The match itself, or one as long as the query that begins or ends no more than a quarter of the
/// query outside it: matches are whole steps, which are not those of the query. It must be the same
/// motion, but for what samples do not tell, or less than half as far frame by frame: what is a
/// little nearer is no reason to move, for single frames and means of runs are not quite as far
/// from each other.
SignatureMatch at_own_pace(const SignatureMatch& match, const MotionView& query,
                           const MotionView& text, int32_t step);

}  // namespace kinetome
