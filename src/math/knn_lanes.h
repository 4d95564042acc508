// Eight lanes on every build: the rows of a block, the queries of a tile, the children of a node.
// Each lane is computed on its own.
#pragma once

#include <cstdint>
#include <cstring>

#include "lanes.h"

namespace kinetome {

inline constexpr int64_t octet = 8;
using FloatOctet = float __attribute__((vector_size(octet * sizeof(float))));
using FloatQuartet = float __attribute__((vector_size(4 * sizeof(float))));
using DoubleQuartet = double __attribute__((vector_size(4 * sizeof(double))));

inline FloatOctet load_octet(const float* from) {
    FloatOctet lanes;
    std::memcpy(&lanes, from, sizeof lanes);
    return lanes;
}

inline DoubleQuartet load_quartet(const float* from) {
    FloatQuartet lanes;
    std::memcpy(&lanes, from, sizeof lanes);
    return __builtin_convertvector(lanes, DoubleQuartet);
}

/// Bit i is set where a > b in lane i.
inline uint32_t octet_greater(const FloatOctet& a, const FloatOctet& b) {
#if defined(__AVX__)
    return static_cast<uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_GT_OQ)));
#else
    const auto greater = a > b;
    uint32_t bits = 0;
    for (int lane = 0; lane < octet; ++lane) bits |= (greater[lane] ? 1U : 0U) << lane;
    return bits;
#endif
}

/// The gap between two intervals, of which one lies `above` and `below` the other by so much:
/// neither is positive where they overlap.
inline FloatOctet gap_between(const FloatOctet& above, const FloatOctet& below) {
    const FloatOctet gap = above > below ? above : below;
    return gap > FloatOctet{} ? gap : FloatOctet{};
}

}  // namespace kinetome
