// A few bits that reach tables keep for a cell: the lengths of the substrings that lead to it.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace kinetome {

/// Words × 64 bits, numbered from 0.
template <int Words>
class ReachMask {
  public:
    static constexpr int32_t bits = Words * 64;

    /// Bits 0 … count - 1; count in [0, bits].
    static ReachMask lowest(int32_t count) {
        ReachMask mask;
        for (size_t w = 0; count > 0; ++w, count -= 64) {
            mask.words_[w] = ~uint64_t{0} >> (count >= 64 ? 0 : 64 - count);
        }
        return mask;
    }

    bool any() const {
        uint64_t all = 0;
        for (const uint64_t word : words_) all |= word;
        return all != 0;
    }
    /// Every bit d moved to d + 1; the last one is lost.
    ReachMask shifted() const {
        ReachMask mask;
        uint64_t carried = 0;
        for (size_t w = 0; w < words_.size(); ++w) {
            mask.words_[w] = words_[w] << 1U | carried;
            carried = words_[w] >> 63U;
        }
        return mask;
    }
    ReachMask& operator|=(const ReachMask& other) {
        for (size_t w = 0; w < words_.size(); ++w) words_[w] |= other.words_[w];
        return *this;
    }
    ReachMask& operator&=(const ReachMask& other) {
        for (size_t w = 0; w < words_.size(); ++w) words_[w] &= other.words_[w];
        return *this;
    }
    friend ReachMask operator|(ReachMask a, const ReachMask& b) { return a |= b; }
    friend ReachMask operator&(ReachMask a, const ReachMask& b) { return a &= b; }
    ReachMask without(const ReachMask& other) const {
        ReachMask mask = *this;
        for (size_t w = 0; w < words_.size(); ++w) mask.words_[w] &= ~other.words_[w];
        return mask;
    }

    /// Calls visit(bit) for every one, ascending.
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (size_t w = 0; w < words_.size(); ++w) {
            for (uint64_t word = words_[w]; word != 0; word &= word - 1) {
                visit(static_cast<int32_t>(w) * 64 + std::countr_zero(word));
            }
        }
    }

  private:
    std::array<uint64_t, static_cast<size_t>(Words)> words_{};
};

}  // namespace kinetome
