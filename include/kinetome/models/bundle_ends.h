// From substrings to frames: where submotions begin and end (S1 §3.5).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/models/motion_bundle.h"

namespace kinetome {

struct BundleEndOptions {
    int32_t sweeps = 60;  ///< through all ends at most; it stops after one that gains nothing
    uint64_t seed = 1;    ///< of the order in which ends are visited
};

/// J: letters at which a member of a bundle with several begins or ends, ascending.
std::vector<int32_t> bundle_end_letters(std::span<const SubstringBundle> bundles);

struct BundleEnds {
    std::vector<int32_t> frames;  ///< f(j) by letter of the string, in its clip, at the pose rate
    double first_score = 0;  ///< sum of Eq. 6 over all bundles with f(j) = F̄(j), rounded down
    double score = 0;        ///< the same in the end
    int32_t sweeps = 0;
};

/// Chooses a frame of F(j) for every letter of J so that the submotions of a bundle begin alike,
/// end alike and last alike: |cov Θ(i)| + |cov Θ(i')| + var(i' - i) is least (S1 Eq. 6; |cov| is
/// the trace, the determinant being 0 when there are fewer members than dimensions). All other
/// letters have F̄(j), rounded down. `poses` (n × D) holds the projected poses of F(j) for each j
/// of `letters`, one after another. Throws std::invalid_argument when the shapes disagree.
BundleEnds find_bundle_ends(const MotionString& string, std::span<const SubstringBundle> bundles,
                            std::span<const int32_t> letters, const MatrixFView& poses,
                            const BundleEndOptions& options = {});

}  // namespace kinetome
