// Motion strings (S1 §3.2): a take as the letters it passes through.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/base/pieces.h"
#include "kinetome/math/mixture.h"

namespace kinetome {

struct MotionStringOptions {
    double longest_submotion = 200.0 / 120.0;  ///< λ′ in seconds (S1 §3.6: 200 frames)
    double tau = 0;                            ///< τ of Eq. 2; 0: by tau_quantile
    double tau_quantile = 0.75;  ///< of the distances between adjacent letters (S1: 0.5)
};

/// The m letters of a run of clips, repetitions collapsed inside clips only: a letter never spans
/// a clip break, even where both sides are equal.
struct MotionString {
    std::vector<int32_t> letters;      ///< m, s(j)
    std::vector<int32_t> clip;         ///< m, index of the clip in the order given
    std::vector<int32_t> first_frame;  ///< m, F(j) = [first_frame, end_frame) in its clip
    std::vector<int32_t> end_frame;    ///< m

    int64_t size() const { return static_cast<int64_t>(letters.size()); }
    /// F̄(j): mean of the frame numbers of F(j), in its clip.
    double mean_frame(int64_t j) const;
    /// p(j): whether the interval between letters j and j + 1 is a clip break.
    bool breaks_after(int64_t j) const;
};

void pack(Packer& out, const MotionString& string);
void unpack(Unpacker& in, MotionString& string);

/// `frame_letters` holds a letter a frame, the clips one after another; `clip_frames` their
/// lengths.
MotionString make_motion_string(std::span<const int32_t> frame_letters,
                                std::span<const int64_t> clip_frames);

/// Quantile of d(s(j), s(j - 1)) over adjacent letters inside clips (S1 §3.6: the median): the
/// lower of the two that it falls between; 0 when there is no such pair. `quantile` in [0, 1].
double adjacent_distance(const MotionString& string, const Mixture& mixture, double quantile);

/// λ = λ′ (m - 1) / Σ (F̄(j) - F̄(j - 1)), adjacent letters inside clips, rounded, at least 2
/// (S1 Eq. 7). λ′ in frames.
int64_t longest_substring(const MotionString& string, double longest_submotion_frames);

}  // namespace kinetome
