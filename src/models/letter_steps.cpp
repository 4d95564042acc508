#include <algorithm>
#include <bit>
#include <cmath>

#include "kinetome/models/motion_bundle.h"

namespace kinetome {
namespace {

double squared_step(const Mixture& mixture, int32_t a, int32_t b) {
    return (mixture.means.row(a) - mixture.means.row(b)).squaredNorm();
}

}  // namespace

double median_adjacent_step(const MotionString& string, const Mixture& mixture) {
    std::vector<double> squared;
    for (int64_t j = 0; j + 1 < string.size(); ++j) {
        const auto i = static_cast<size_t>(j);
        if (!string.breaks_after(j))
            squared.push_back(squared_step(mixture, string.letters[i], string.letters[i + 1]));
    }
    if (squared.empty()) return 0;
    const auto middle = squared.begin() + static_cast<std::ptrdiff_t>((squared.size() - 1) / 2);
    std::nth_element(squared.begin(), middle, squared.end());
    return std::sqrt(*middle);
}

AccessibilityMatrix within_step(const AccessibilityMatrix& accessibility, const Mixture& mixture,
                                double step) {
    AccessibilityMatrix near(accessibility.letters());
    const int64_t words_per_row = accessibility.words_per_row();
    for (int32_t a = 0; a < accessibility.letters(); ++a) {
        for (int64_t w = 0; w < words_per_row; ++w) {
            uint64_t word = accessibility.words()[static_cast<size_t>(a * words_per_row + w)];
            for (; word != 0; word &= word - 1) {
                const auto b = static_cast<int32_t>(w * 64 + std::countr_zero(word));
                if (b > a && squared_step(mixture, a, b) <= step * step) near.set(a, b);
            }
        }
    }
    return near;
}

}  // namespace kinetome
