#include "kinetome/base/digest.h"

#define XXH_STATIC_LINKING_ONLY  // XXH3_state_t by value
#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <bit>
#include <charconv>

#include "kinetome/base/error.h"
#include "kinetome/base/file.h"

namespace kinetome {

static_assert(std::endian::native == std::endian::little, "digests hash numbers as they lie");

struct Hasher::State {
    XXH3_state_t xxh3;
};

std::string Digest::hex() const {
    return fmt::format("{:016x}{:016x}", high, low);
}

Digest Digest::from_hex(std::string_view hex) {
    const auto half = [hex](size_t first) {
        uint64_t value = 0;
        const char* begin = hex.data() + first;
        const auto [end, error] = std::from_chars(begin, begin + 16, value, 16);
        if (error != std::errc() || end != begin + 16) {
            throw StoreError(fmt::format("'{}' is not a digest of 32 hexadecimal digits", hex));
        }
        return value;
    };
    if (hex.size() != 32) {
        throw StoreError(fmt::format("'{}' is not a digest of 32 hexadecimal digits", hex));
    }
    return {half(0), half(16)};
}

Hasher::Hasher() : state_(std::make_unique<State>()) {
    XXH3_128bits_reset(&state_->xxh3);
}
Hasher::~Hasher() = default;
Hasher::Hasher(Hasher&&) noexcept = default;
Hasher& Hasher::operator=(Hasher&&) noexcept = default;

Hasher& Hasher::bytes(const void* data, size_t size) {
    if (size > 0) XXH3_128bits_update(&state_->xxh3, data, size);
    return *this;
}

Hasher& Hasher::text(std::string_view text) {
    return number(text.size()).bytes(text.data(), text.size());
}

Hasher& Hasher::number(uint64_t value) {
    return bytes(&value, sizeof value);
}

Hasher& Hasher::digest(const Digest& value) {
    return number(value.high).number(value.low);
}

Digest Hasher::finish() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(&state_->xxh3);
    return {hash.high64, hash.low64};
}

Digest digest_of(std::string_view bytes) {
    return Hasher().bytes(bytes.data(), bytes.size()).finish();
}

Digest digest_file(const std::filesystem::path& path, uint64_t* size) {
    Hasher hasher;
    uint64_t total = 0;
    read_blocks(path, [&](std::string_view block) {
        hasher.bytes(block.data(), block.size());
        total += block.size();
    });
    if (size) *size = total;
    return hasher.finish();
}

uint64_t hash_name(std::string_view name) {
    return XXH3_64bits(name.data(), name.size());
}

}  // namespace kinetome
