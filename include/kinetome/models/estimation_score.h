// How well principal markers tell where the others are, on poses that no model has seen (S2 §6), by
// the pose hierarchy and by simpler means.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinetome/base/communicator.h"
#include "kinetome/base/matrix.h"
#include "kinetome/base/pieces.h"
#include "kinetome/models/hierarchy_growth.h"
#include "kinetome/models/principal_markers.h"

namespace kinetome {

/// Markers that are estimated: neither principal nor the origin.
int64_t estimated_markers(const PrincipalMarkers& principal, int64_t columns);

/// mm: RMS over the estimated markers of one pose (f) and its estimate, whose principal columns are
/// those of the pose.
double estimation_error(std::span<const float> pose, const VectorD& estimate, int64_t markers);

/// Which poses are kept from training. "80 % for training" (S2 §6) can mean each of these, and the
/// results differ by an order of magnitude.
enum class HeldOut {
    frames,  ///< single frames at random: nearly the same pose is in the training set
    blocks,  ///< stretches of takes: the same performance is
    takes    ///< whole takes
};

struct HeldOutOptions {
    HeldOut what = HeldOut::takes;
    double share_of_frames = 0.2;  ///< frames: of all
    double block_seconds = 4;      ///< blocks: how long one is …
    int64_t every_block = 5;       ///< … and the last of so many is held out
    int64_t every_take = 14;       ///< takes: the last of so many, by name, is held out
    uint64_t seed = 1;             ///< frames: of the draw
};

/// One a pose: whether it is held out. `takes` follow one another and cover the poses; `rate` in
/// frames a second.
std::vector<bool> held_out(std::span<const RowRange> takes, double rate,
                           const HeldOutOptions& options);

struct EstimationScore {
    std::string method;
    double rms = 0;       ///< mm per estimated marker
    double share_95 = 0;  ///< mm: 95 % of the poses are no worse
    double greatest = 0;  ///< mm
};

struct EstimationScores {
    PrincipalMarkers principal;
    int64_t leaves = 0;
    int64_t training = 0, tested = 0;  ///< poses
    std::vector<EstimationScore> scores;
};

/// Trains on some poses (n × f, cm), tests on others: one linear map for all, the nearest pose and
/// the mean of the 8 nearest by principal markers, and the hierarchy's maps by least squares (S2
/// Eq. 1), by shrinkage, and blended near planes. Throws std::invalid_argument where either has no
/// poses.
EstimationScores score_estimation(const MatrixF& training, const MatrixF& test,
                                  const PrincipalMarkerOptions& marker_options,
                                  const PoseHierarchyOptions& options, const Workers& workers);

}  // namespace kinetome
