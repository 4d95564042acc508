// Where motion bundles begin: instances of the most frequent unpartitioned letter (S1 §3.3).
#pragma once

#include <cstdint>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "kinetome/models/letter_index.h"
#include "kinetome/models/substring.h"

namespace kinetome {

/// A letter is unpartitioned while an interval beside it is open.
class BundleSeeds {
  public:
    /// Refers to index and intervals. Letters of the string, as many as `letters`.
    BundleSeeds(const MotionString& string, int64_t letters, const LetterIndex& index,
                const IntervalSet& open, uint64_t seed);

    /// An instance of the letter with most of them, ties to the lowest; which instance depends on
    /// the seed, the letter and how many are left. None when all letters are partitioned.
    std::optional<int32_t> next();
    /// To be called after the substring's intervals, which were open, have been closed.
    void closed(const Substring& substring);

  private:
    using CountedLetter = std::pair<int64_t, int32_t>;  ///< instances, -letter
    bool is_open(int32_t position) const;
    int64_t& count_of(int32_t letter) { return counts_[static_cast<size_t>(letter)]; }

    const MotionString& string_;
    const LetterIndex& index_;
    const IntervalSet& open_;
    uint64_t seed_;
    std::vector<int64_t> counts_;                       ///< unpartitioned instances, by letter
    std::priority_queue<CountedLetter> most_frequent_;  ///< counts as they once were, never too low
};

}  // namespace kinetome
