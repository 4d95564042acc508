// What a piece of work costs, and the middle of several turns: shared by the benchmarks.
#pragma once

#include <algorithm>
#include <chrono>
#include <vector>

#include "kinetome/base/resources.h"

namespace kinetome::bench {

/// Seconds.
struct Cost {
    double wall = 0;
    double cpu = 0;  ///< of all threads
};

template <class Work>
Cost cost_of(Work&& work) {
    const auto started = std::chrono::steady_clock::now();
    const double cpu_started = cpu_seconds();
    work();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - started;
    return {wall.count(), cpu_seconds() - cpu_started};
}

inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

}  // namespace kinetome::bench
