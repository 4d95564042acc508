#include <algorithm>
#include <bit>
#include <cmath>

#include "kinetome/math/quantiles.h"
#include "kinetome/models/motion_bundle.h"

namespace kinetome {
namespace {

double squared_step(const Mixture& mixture, int32_t a, int32_t b) {
    return (mixture.means.row(a) - mixture.means.row(b)).squaredNorm();
}

}  // namespace

double adjacent_step(const MotionString& string, const Mixture& mixture, double quantile) {
    std::vector<double> squared;
    for (int64_t j = 0; j + 1 < string.size(); ++j) {
        const auto i = static_cast<size_t>(j);
        if (!string.breaks_after(j))
            squared.push_back(squared_step(mixture, string.letters[i], string.letters[i + 1]));
    }
    return std::sqrt(lower_quantile(std::move(squared), quantile));
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

AccessibilityMatrix accessibility_for_bundles(const AccessibilityMatrix& accessibility,
                                              const MotionString& string, const Mixture& mixture,
                                              const MotionBundleOptions& options) {
    constexpr double median = 0.5;
    const double quantile = options.spread == BundleSpread::closure_near
                                ? std::min(median, options.step_quantile)
                                : options.step_quantile;
    if (quantile >= 1) return accessibility;
    return within_step(accessibility, mixture, adjacent_step(string, mixture, quantile));
}

}  // namespace kinetome
