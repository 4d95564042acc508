// How two motions that go on together answer each other.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>

namespace kinetome {

/// The share that answers a share of the other motion; `registration` holds those that answer even
/// ones, from 0 to 1 (MotionRun::registration). Empty: the same share.
inline double registered_share(std::span<const double> registration, double share) {
    if (registration.empty()) return share;
    const double at = share * static_cast<double>(registration.size() - 1);
    const auto knot = std::min(static_cast<size_t>(at), registration.size() - 2);
    return std::lerp(registration[knot], registration[knot + 1], at - static_cast<double>(knot));
}

/// Throws std::invalid_argument unless shares ascend from 0 to 1, or there are none.
inline void check_registration(std::span<const double> registration) {
    if (registration.empty()) return;
    if (registration.size() < 2 || registration.front() != 0 || registration.back() != 1 ||
        !std::ranges::is_sorted(registration)) {
        throw std::invalid_argument("a registration does not ascend from 0 to 1");
    }
}

}  // namespace kinetome
