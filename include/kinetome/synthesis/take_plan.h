// What happens in a take, and when: the known truth of the procedural corpus.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinetome/synthesis/activity.h"
#include "kinetome/synthesis/style.h"

namespace kinetome {

inline constexpr double synthesis_rate = 120;  ///< frames a second

/// One repetition. Times are frames of the take and need not be whole.
struct CyclePlan {
    double first = 0;
    double frames = 0;
    Traits traits;
};

/// One activity without a pause.
struct SegmentPlan {
    Activity activity = Activity::idle;
    bool mirrored = false;  ///< left and right exchanged (the label is already that of the mirror)
    int64_t first = 0, end = 0;              ///< frames, end exclusive
    int64_t blend_first = 0, blend_end = 0;  ///< of the blend into the next one, around `end`
    Posture carriage;
    std::vector<CyclePlan> cycles;  ///< one after another, from `first` to past `blend_end`

    /// The label of what is seen.
    Activity label() const;
};

struct TakePlan {
    int64_t index = 0;    ///< in the corpus
    int64_t subject = 0;  ///< counted from 1
    int64_t number = 0;   ///< in the subject, counted from 1
    int64_t frames = 0;
    std::vector<SegmentPlan> segments;  ///< without gaps from 0 to `frames`

    std::string subject_name() const;  ///< "03"
    std::string name() const;          ///< "03_07"
};

/// Lengths of the takes of a corpus of `frames` frames: 5 to 60 seconds, many short and few long
/// ones, 1,570 frames in the mean as in CMU's collection; they add up exactly. Fewer than 5 seconds
/// in all make one take.
std::vector<int64_t> take_lengths(int64_t frames, uint64_t seed);

/// Which subject performs which take: in order, as evenly as possible.
/// `subjects` 0: one for every 12 takes.
int64_t subject_count(int64_t takes, int64_t subjects);
int64_t subject_of_take(int64_t take, int64_t takes, int64_t subjects);

/// Draws activities, styles, cycles and blends of one take, from streams of its own.
TakePlan plan_take(int64_t index, int64_t frames, int64_t subject, int64_t number, uint64_t seed);

}  // namespace kinetome
