// Quantiles that are one of the values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace kinetome {

/// The lower of the two values that the quantile falls between; 0 of none. `quantile` in [0, 1].
inline double lower_quantile(std::vector<double> values, double quantile) {
    if (values.empty()) return 0;
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(
                                            static_cast<double>(values.size() - 1) * quantile);
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

}  // namespace kinetome
