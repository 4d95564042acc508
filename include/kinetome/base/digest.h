// 128-bit content hashes (XXH3): of files, of logical rows, of option texts, of names.
// They find damage and equality; they are no defence against a forger.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace kinetome {

struct Digest {
    uint64_t high = 0;
    uint64_t low = 0;

    /// 32 lower-case hexadecimal digits, as `xxh128sum` prints them.
    std::string hex() const;
    /// Throws StoreError unless `hex` is 32 hexadecimal digits.
    static Digest from_hex(std::string_view hex);

    auto operator<=>(const Digest&) const = default;
};

/// Streaming hash: the order and the bytes count, the cutting into updates does not.
class Hasher {
  public:
    Hasher();
    ~Hasher();
    Hasher(Hasher&&) noexcept;
    Hasher& operator=(Hasher&&) noexcept;

    Hasher& bytes(const void* data, size_t size);
    /// Length first, so that ("ab", "c") and ("a", "bc") differ.
    Hasher& text(std::string_view text);
    Hasher& number(uint64_t value);
    Hasher& digest(const Digest& value);
    template <class T>
    Hasher& values(std::span<const T> values) {
        return bytes(values.data(), values.size_bytes());
    }
    Digest finish() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

Digest digest_of(std::string_view bytes);

/// Hash of a file's bytes; sets `*size` when given. Throws StoreError when it cannot be read.
Digest digest_file(const std::filesystem::path& path, uint64_t* size = nullptr);

/// 64-bit hash of a clip's name: where shards and groups are cut, and the clip's id, come from it.
uint64_t hash_name(std::string_view name);

}  // namespace kinetome
