#include "kinetome/models/letter_index.h"

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace kinetome {

LetterIndex::LetterIndex(const MotionString& string, const AccessibilityMatrix& accessibility)
    : positions_(static_cast<size_t>(accessibility.letters())),
      accessible_(static_cast<size_t>(accessibility.letters())) {
    for (size_t j = 0; j < string.letters.size(); ++j) {
        const int32_t letter = string.letters[j];
        if (letter < 0 || letter >= accessibility.letters())
            throw std::invalid_argument(
                "the motion string has a letter that no cluster stands for");
        positions_[static_cast<size_t>(letter)].push_back(static_cast<int32_t>(j));
    }
    const auto words_per_row = static_cast<size_t>(accessibility.words_per_row());
    for (size_t a = 0; a < positions_.size(); ++a) {
        if (positions_[a].empty()) continue;
        std::vector<int32_t>& all = accessible_[a];
        for (size_t w = 0; w < words_per_row; ++w) {
            uint64_t word = accessibility.words()[a * words_per_row + w];
            for (; word != 0; word &= word - 1) {
                const auto& of_letter =
                    positions_[w * 64 + static_cast<size_t>(std::countr_zero(word))];
                all.insert(all.end(), of_letter.begin(), of_letter.end());
            }
        }
        std::ranges::sort(all);
    }
}

std::span<const int32_t> LetterIndex::positions(int32_t letter) const {
    return positions_[static_cast<size_t>(letter)];
}

std::span<const int32_t> LetterIndex::accessible_positions(int32_t letter) const {
    return accessible_[static_cast<size_t>(letter)];
}

}  // namespace kinetome
