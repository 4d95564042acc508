// Counter-based random numbers (Philox 4x32-10; Salmon et al. 2011): a stream is named by
// (seed, stage, item), so what an item draws depends on nothing that ran before it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

namespace kinetome {

/// The Philox 4x32-10 block function.
std::array<uint32_t, 4> philox(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key);

/// A stream of its own for each (seed, stage, item). Models UniformRandomBitGenerator, but prefer
/// the members below to <random>'s distributions, whose results differ between libraries.
class RandomStream {
  public:
    using result_type = uint64_t;

    RandomStream(uint64_t seed, std::string_view stage, uint64_t item = 0);

    static constexpr result_type min() { return 0; }
    static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
    result_type operator()();

    /// In [0, 1), 53 bits.
    double uniform();
    /// In [low, high).
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    /// In [0, bound), without bias; bound > 0.
    uint64_t below(uint64_t bound);
    /// Standard normal.
    double normal();

  private:
    std::array<uint32_t, 2> key_;
    uint64_t item_;
    uint64_t block_ = 0;
    std::array<uint32_t, 4> buffer_{};
    int used_ = 4;
    double spare_normal_ = 0;
    bool has_spare_ = false;
};

}  // namespace kinetome
