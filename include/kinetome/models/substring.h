// Substrings of a motion string and sets of the intervals between its letters (S1 §3.3).
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kinetome {

/// Letters first … last of a motion string, both included: S1's (j, j').
struct Substring {
    int32_t first = 0, last = 0;

    int32_t letters() const { return last - first + 1; }
    auto operator<=>(const Substring&) const = default;
};

/// Interval j lies between letters j and j + 1. A substring covers the intervals between its
/// letters.
class IntervalSet {
  public:
    explicit IntervalSet(int64_t intervals = 0);

    bool contains(int32_t interval) const {
        return (word_of(interval) >> (interval % bits_per_word)) & 1U;
    }
    bool contains_all(const Substring& covered) const;
    bool contains_any(const Substring& covered) const;
    void insert(const Substring& covered);
    void erase(const Substring& covered);

    /// How many intervals straight before a letter (straight after it) are in the set; counts to
    /// `most`.
    int32_t run_before(int32_t letter, int32_t most) const;
    int32_t run_after(int32_t letter, int32_t most) const;

  private:
    static constexpr int32_t bits_per_word = 64;
    uint64_t word_of(int32_t interval) const {
        return words_[static_cast<size_t>(interval / bits_per_word)];
    }
    /// Calls visit(word, bits) for the words that hold what the substring covers.
    template <class Visit>
    static void for_each_word(const Substring& covered, const Visit& visit);

    int64_t intervals_ = 0;
    std::vector<uint64_t> words_;
};

}  // namespace kinetome
