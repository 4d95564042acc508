// Quantiles that are one of the values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace kinetome {

/// The lower of the two values that the quantile falls between; 0 of none. `quantile` in [0, 1].
template <class Value>
Value lower_quantile(std::vector<Value> values, double quantile) {
    if (values.empty()) return 0;
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(
                                            static_cast<double>(values.size() - 1) * quantile);
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

/// The upper of the two values in the middle, or the one that is there; 0 of none.
template <class Value>
Value upper_median(std::vector<Value> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace kinetome
