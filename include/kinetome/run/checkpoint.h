// Checkpoints inside a stage: small files in the run folder that a killed run goes on from.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "kinetome/base/error.h"

namespace kinetome {

/// Numbers and arrays, in the order they are put.
class CheckpointWriter {
  public:
    template <class T>
    requires std::is_arithmetic_v<T> CheckpointWriter& put(T value) {
        return bytes(&value, sizeof value);
    }
    template <class T>
    requires std::is_arithmetic_v<T> CheckpointWriter& put(std::span<const T> values) {
        put(static_cast<uint64_t>(values.size()));
        return bytes(values.data(), values.size_bytes());
    }

    /// Replaces the file as a whole. Not synced: a checkpoint guards against a killed process, and
    /// after a power failure its hash tells. Throws CreateError.
    void save(const std::filesystem::path& path) const;

  private:
    CheckpointWriter& bytes(const void* data, size_t size) {
        bytes_.append(static_cast<const char*>(data), size);
        return *this;
    }
    std::string bytes_;
};

/// Gets back in the same order what a CheckpointWriter put.
class CheckpointReader {
  public:
    /// Nothing when there is no whole checkpoint at `path`.
    static std::optional<CheckpointReader> open(const std::filesystem::path& path);

    template <class T>
    requires std::is_arithmetic_v<T> T get() {
        T value;
        take(&value, sizeof value);
        return value;
    }
    template <class T>
    requires std::is_arithmetic_v<T> std::vector<T> get_all() {
        const auto count = get<uint64_t>();
        if (count > (bytes_.size() - at_) / sizeof(T)) throw StoreError("checkpoint is too short");
        std::vector<T> values(count);
        take(values.data(), count * sizeof(T));
        return values;
    }

  private:
    void take(void* data, size_t size);
    std::string bytes_;
    size_t at_ = 0;
};

}  // namespace kinetome
