// Vectors of floats as wide as the build's registers. Every lane is computed on its own, in one
// order, so that results do not depend on the width.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <vector>
#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace kinetome {

#if defined(__AVX512F__)
inline constexpr int lane_count = 16;
#else
inline constexpr int lane_count = 8;
#endif

using Lanes = float __attribute__((vector_size(lane_count * sizeof(float))));
using LaneIntegers = int32_t __attribute__((vector_size(lane_count * sizeof(int32_t))));

/// Buffers the loads below never split over two cache lines.
using LaneBuffer = std::vector<float, Eigen::aligned_allocator<float>>;

inline Lanes load_lanes(const float* from) {
    Lanes lanes;
    std::memcpy(&lanes, from, sizeof lanes);
    return lanes;
}

inline void store_lanes(const Lanes& lanes, float* to) {
    std::memcpy(to, &lanes, sizeof lanes);
}

inline Lanes all_lanes(float value) {
    return value - Lanes{};
}

/// The second where either is not a number.
inline Lanes larger(const Lanes& a, const Lanes& b) {
    return a > b ? a : b;
}

/// Bit i is set where a > b in lane i.
inline uint32_t lanes_greater(const Lanes& a, const Lanes& b) {
#if defined(__AVX512F__)
    return _mm512_cmp_ps_mask(a, b, _CMP_GT_OQ);
#elif defined(__AVX__)
    return static_cast<uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_GT_OQ)));
#else
    const LaneIntegers greater = a > b;
    uint32_t bits = 0;
    for (int lane = 0; lane < lane_count; ++lane) bits |= (greater[lane] ? 1U : 0U) << lane;
    return bits;
#endif
}
inline bool any_greater(const Lanes& a, const Lanes& b) {
    return lanes_greater(a, b) != 0;
}
inline bool all_greater(const Lanes& a, const Lanes& b) {
    return lanes_greater(a, b) == (uint32_t{1} << lane_count) - 1;
}

/// e^x for x in [-87, 0], to about two units in the last place; below -87 it stays at e^-87.
/// x = n ln 2 + r, |r| <= ln 2 / 2; ln 2 in two parts so that r keeps its digits, e^r by its Taylor
/// series (the next term is r^7/5040 < 1.3e-7 of it at the ends).
inline Lanes exponential(Lanes x) {
    x = larger(x, all_lanes(-87.0F));
    const LaneIntegers n = __builtin_convertvector(x * 1.44269504F - 0.5F, LaneIntegers);
    const Lanes whole = __builtin_convertvector(n, Lanes);
    const Lanes r = (x - whole * 0.693359375F) + whole * 2.12194440e-4F;
    Lanes series = r * (1 / 5040.0F) + 1 / 720.0F;
    series = series * r + 1 / 120.0F;
    series = series * r + 1 / 24.0F;
    series = series * r + 1 / 6.0F;
    series = series * r + 0.5F;
    series = series * r + 1.0F;
    series = series * r + 1.0F;
    const LaneIntegers exponent = (n + 127) << 23;
    Lanes scale;
    std::memcpy(&scale, &exponent, sizeof scale);
    return series * scale;
}

}  // namespace kinetome
