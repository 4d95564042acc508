// What sums in a tree must give, by definition.
#pragma once

#include <cmath>
#include <vector>

#include "kinetome/base/random.h"

namespace kinetome::test {

inline void add(double& left, const double& right) {
    left += right;
}

/// Values of both signs and of very different sizes, so that the order of a sum shows in its bits.
inline std::vector<double> sensitive_values(size_t count) {
    RandomStream random(1, "values");
    std::vector<double> values(count);
    for (double& value : values) value = random.normal() * std::exp(10 * random.normal());
    return values;
}

/// The tree by its definition, one level after the other.
template <class Sum, class Merge>
Sum tree_sum(std::vector<Sum> level, Merge merge) {
    while (level.size() > 1) {
        std::vector<Sum> above;
        for (size_t i = 0; i < level.size(); i += 2) {
            above.push_back(level[i]);
            if (i + 1 < level.size()) merge(above.back(), level[i + 1]);
        }
        level = std::move(above);
    }
    return level.front();
}

}  // namespace kinetome::test
