// One motion bundle out of all substrings that are similar (S1 §3.3, §3.4): occurrences that do not
// overlap, of lengths that agree.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinetome/models/motion_string.h"
#include "kinetome/models/substring.h"

namespace kinetome {

/// V = (B_h - 1) · B_w^ρ: members, and their mean length in frames                (S1 Eq. 3)
double bundle_volume(int64_t height, double width, double rho);

struct BundleMembers {
    std::vector<Substring> members;  ///< ascending
    double mean_frames = 0;          ///< B_w, as F̄ estimates it
};

/// Chooses members among similar substrings, of which many are variants of one occurrence.
class MemberChoice {
  public:
    explicit MemberChoice(const MotionString& string);

    /// Takes what is similar; the order is of no matter.
    void consider(std::span<const Substring> similar);
    /// `reference`, one of them, first; then those whose lengths are nearest to its own by ratio
    /// (ties: the shorter, then the first in the string), as far as they share no interval with one
    /// taken before. At last all go whose length is less than γ or more than 1/γ times the mean.
    BundleMembers choose(const Substring& reference, double gamma);
    /// The same by the mean length of all that are similar, which must be some: rounded to half
    /// frames, up from the middle, as all lengths are. No substring is preferred.
    BundleMembers choose_by_mean(double gamma);

  private:
    struct Candidate {
        int64_t half_frames = 0;
        Substring substring;
        auto operator<=>(const Candidate&) const = default;
    };
    void take(const Candidate& candidate);
    void take_nearest(int64_t wanted);
    BundleMembers taken_within(double gamma);

    const MotionString& string_;
    std::vector<Candidate> candidates_;  ///< ascending
    std::vector<Candidate> taken_;
    IntervalSet used_;  ///< by those taken
};

}  // namespace kinetome
