#include "kinetome/base/random.h"

#include <cmath>

#include "kinetome/base/digest.h"
#include "wide_integer.h"

namespace kinetome {
namespace {

constexpr int rounds = 10;
constexpr uint64_t multiplier_0 = 0xD2511F53, multiplier_1 = 0xCD9E8D57;
constexpr uint32_t weyl_0 = 0x9E3779B9, weyl_1 = 0xBB67AE85;

uint32_t low_word(uint64_t value) {
    return static_cast<uint32_t>(value);
}
uint32_t high_word(uint64_t value) {
    return static_cast<uint32_t>(value >> 32);
}

std::array<uint32_t, 2> key_of(uint64_t seed, std::string_view stage) {
    const uint64_t key = Hasher().number(seed).text(stage).finish().low;
    return {low_word(key), high_word(key)};
}

}  // namespace

std::array<uint32_t, 4> philox(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key) {
    for (int round = 0; round < rounds; ++round) {
        const uint64_t product_0 = multiplier_0 * counter[0];
        const uint64_t product_1 = multiplier_1 * counter[2];
        counter = {high_word(product_1) ^ counter[1] ^ key[0], low_word(product_1),
                   high_word(product_0) ^ counter[3] ^ key[1], low_word(product_0)};
        key[0] += weyl_0;
        key[1] += weyl_1;
    }
    return counter;
}

RandomStream::RandomStream(uint64_t seed, std::string_view stage, uint64_t item)
    : key_(key_of(seed, stage)), item_(item) {}

RandomStream::result_type RandomStream::operator()() {
    if (used_ == 4) {
        buffer_ =
            philox({low_word(block_), high_word(block_), low_word(item_), high_word(item_)}, key_);
        ++block_;
        used_ = 0;
    }
    const auto word = static_cast<size_t>(used_);
    used_ += 2;
    return (uint64_t{buffer_[word + 1]} << 32) | buffer_[word];
}

double RandomStream::uniform() {
    return static_cast<double>((*this)() >> 11) * 0x1p-53;
}

// Lemire 2019, "Fast random integer generation in an interval": the draws whose low half falls
// short of 2^64 mod bound would make some results likelier than others, and are drawn again.
uint64_t RandomStream::below(uint64_t bound) {
    WideUnsigned product = WideUnsigned{(*this)()} * bound;
    if (static_cast<uint64_t>(product) < bound) {
        const uint64_t surplus = (0 - bound) % bound;
        while (static_cast<uint64_t>(product) < surplus) product = WideUnsigned{(*this)()} * bound;
    }
    return static_cast<uint64_t>(product >> 64);
}

// Marsaglia's polar method: a point of the unit disc gives two normals.
double RandomStream::normal() {
    if (has_spare_) {
        has_spare_ = false;
        return spare_normal_;
    }
    double x = 0, y = 0, square = 0;
    do {
        x = uniform(-1, 1);
        y = uniform(-1, 1);
        square = x * x + y * y;
    } while (square >= 1 || square == 0);
    const double scale = std::sqrt(-2 * std::log(square) / square);
    spare_normal_ = y * scale;
    has_spare_ = true;
    return x * scale;
}

}  // namespace kinetome
