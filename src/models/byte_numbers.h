// Whole numbers in as few bytes as they need: seven bits a byte, the sign in the lowest.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace kinetome {

class NumberWriter {
  public:
    void put(int64_t number) {
        auto rest = static_cast<uint64_t>(number) << 1U ^ static_cast<uint64_t>(number >> 63);
        for (; rest >= 0x80U; rest >>= 7U) bytes_ += static_cast<char>(rest | 0x80U);
        bytes_ += static_cast<char>(rest);
    }
    std::string take() { return std::move(bytes_); }

  private:
    std::string bytes_;
};

/// Throws std::out_of_range when there is no whole number left.
class NumberReader {
  public:
    explicit NumberReader(std::string_view bytes) : bytes_(bytes) {}

    int64_t get() {
        uint64_t rest = 0;
        for (unsigned shift = 0; shift < 64; shift += 7) {
            if (at_ == bytes_.size()) throw std::out_of_range("compressed numbers end too early");
            const auto byte = static_cast<uint8_t>(bytes_[at_++]);
            rest |= static_cast<uint64_t>(byte & 0x7FU) << shift;
            if (byte < 0x80U) {
                return static_cast<int64_t>(rest >> 1U) ^ -static_cast<int64_t>(rest & 1U);
            }
        }
        throw std::out_of_range("a compressed number is longer than any");
    }
    /// Throws std::out_of_range unless it lies in [low, high].
    int64_t get(int64_t low, int64_t high) {
        const int64_t number = get();
        if (number < low || number > high) {
            throw std::out_of_range("a compressed number is not one that can be there");
        }
        return number;
    }
    bool at_end() const { return at_ == bytes_.size(); }

  private:
    std::string_view bytes_;
    size_t at_ = 0;
};

}  // namespace kinetome
