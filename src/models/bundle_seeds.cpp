#include "kinetome/models/bundle_seeds.h"

#include "kinetome/base/random.h"

namespace kinetome {

BundleSeeds::BundleSeeds(const MotionString& string, int64_t letters, const LetterIndex& index,
                         const IntervalSet& open, uint64_t seed)
    : string_(string),
      index_(index),
      open_(open),
      seed_(seed),
      counts_(static_cast<size_t>(letters)) {
    for (int32_t j = 0; j < string.size(); ++j) {
        if (is_open(j)) ++count_of(string.letters[static_cast<size_t>(j)]);
    }
    for (int32_t letter = 0; letter < letters; ++letter) {
        most_frequent_.emplace(count_of(letter), -letter);
    }
}

bool BundleSeeds::is_open(int32_t position) const {
    return open_.run_before(position, 1) > 0 || open_.run_after(position, 1) > 0;
}

std::optional<int32_t> BundleSeeds::next() {
    while (!most_frequent_.empty()) {
        const auto [count_then, negated] = most_frequent_.top();
        const int32_t letter = -negated;
        const int64_t count = count_of(letter);
        if (count < count_then) {
            most_frequent_.pop();
            most_frequent_.emplace(count, negated);
            continue;
        }
        if (count == 0) return std::nullopt;
        // Each pair of letter and count is met once at most: counts only fall.
        const uint64_t item = static_cast<uint64_t>(letter) << 32U | static_cast<uint64_t>(count);
        uint64_t instance =
            RandomStream(seed_, "motion bundle", item).below(static_cast<uint64_t>(count));
        for (const int32_t position : index_.positions(letter)) {
            if (is_open(position) && instance-- == 0) return position;
        }
    }
    return std::nullopt;
}

void BundleSeeds::closed(const Substring& substring) {
    for (int32_t j = substring.first; j <= substring.last; ++j) {
        if (!is_open(j)) --count_of(string_.letters[static_cast<size_t>(j)]);
    }
}

}  // namespace kinetome
