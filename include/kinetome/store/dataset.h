// What a dataset of an artifact is, and the digest of its logical content.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "kinetome/base/digest.h"

namespace kinetome {

enum class ElementType { float32, float64, int32, int64, uint8, uint64, text };

/// "float32", …
std::string name_of(ElementType type);
/// Bytes of one value; 0 for texts, whose width is their dataset's.
int64_t element_bytes(ElementType type);

template <class T>
constexpr ElementType element_type_of() {
    if constexpr (std::is_same_v<T, float>) {
        return ElementType::float32;
    } else if constexpr (std::is_same_v<T, double>) {
        return ElementType::float64;
    } else if constexpr (std::is_same_v<T, int32_t>) {
        return ElementType::int32;
    } else if constexpr (std::is_same_v<T, int64_t>) {
        return ElementType::int64;
    } else if constexpr (std::is_same_v<T, uint8_t>) {
        return ElementType::uint8;
    } else {
        static_assert(std::is_same_v<T, uint64_t>, "no dataset holds this type");
        return ElementType::uint64;
    }
}

/// How the shards of an artifact make up the logical dataset.
enum class Sharding {
    rows,      ///< rows of the shards, one after another in clip order
    constant,  ///< the same in every shard
};

struct DatasetSpec {
    std::string path;  ///< "/31j62d-…/pose_vectors"; parents are made
    ElementType type = ElementType::float32;
    std::vector<int64_t> row_shape = {};  ///< of one row; empty: a scalar; {31, 3}: n × 31 × 3
    std::string units = {};               ///< "cm", "rad", "frames", "1", …
    std::string description = {};
    std::string source = {};  ///< paper and section, or "" where there is none
    std::string frame = {};   ///< coordinate frame: "world, Y up", "facing frame", or ""
    Sharding sharding = Sharding::rows;

    /// Values in one row: the product of its shape.
    int64_t values_per_row() const;

    bool operator==(const DatasetSpec&) const = default;
};

/// Logical digest of a dataset, fed row by row: its path, type and row shape, then the values
/// (texts by content, without padding). Shards fed one after another give the dataset's digest:
/// neither their boundaries nor compression nor the number of calls count.
class DatasetDigest {
  public:
    explicit DatasetDigest(const DatasetSpec& spec);
    /// `count` rows of the dataset's type, not for texts.
    void rows(const void* values, int64_t count);
    void texts(std::span<const std::string> values);
    Digest finish() const { return hasher_.finish(); }

  private:
    Hasher hasher_;
    int64_t row_bytes_ = 0;
};

}  // namespace kinetome
