#include "kinetome/models/substring.h"

#include <algorithm>
#include <bit>

namespace kinetome {

IntervalSet::IntervalSet(int64_t intervals)
    : intervals_(intervals),
      words_(static_cast<size_t>((intervals + bits_per_word - 1) / bits_per_word)) {}

template <class Visit>
void IntervalSet::for_each_word(const Substring& covered, const Visit& visit) {
    for (int32_t interval = covered.first; interval < covered.last;) {
        const int32_t bit = interval % bits_per_word;
        const int32_t count = std::min(bits_per_word - bit, covered.last - interval);
        visit(static_cast<size_t>(interval / bits_per_word),
              (~uint64_t{0} >> (bits_per_word - count)) << bit);
        interval += count;
    }
}

bool IntervalSet::contains_all(const Substring& covered) const {
    bool all = true;
    for_each_word(covered, [&](size_t word, uint64_t bits) { all &= !(bits & ~words_[word]); });
    return all;
}

bool IntervalSet::contains_any(const Substring& covered) const {
    bool any = false;
    for_each_word(covered, [&](size_t word, uint64_t bits) { any |= (bits & words_[word]) != 0; });
    return any;
}

void IntervalSet::insert(const Substring& covered) {
    for_each_word(covered, [&](size_t word, uint64_t bits) { words_[word] |= bits; });
}

void IntervalSet::erase(const Substring& covered) {
    for_each_word(covered, [&](size_t word, uint64_t bits) { words_[word] &= ~bits; });
}

int32_t IntervalSet::run_before(int32_t letter, int32_t most) const {
    int32_t run = 0;
    while (run < most && run < letter) {
        const int32_t bit = (letter - run - 1) % bits_per_word;
        const int ones = std::countl_one(word_of(letter - run - 1) << (bits_per_word - 1 - bit));
        run += ones;
        if (ones <= bit) break;
    }
    return std::min(run, most);
}

int32_t IntervalSet::run_after(int32_t letter, int32_t most) const {
    int32_t run = 0;
    while (run < most && letter + run < intervals_) {
        const int32_t bit = (letter + run) % bits_per_word;
        const int ones = std::countr_one(word_of(letter + run) >> bit);
        run += ones;
        if (ones < bits_per_word - bit) break;
    }
    return std::min(run, most);
}

}  // namespace kinetome
