// Artifacts: HDF5 files that are written once, beside their final name, and seen only when whole
// (temporary name → flush → sync → hash → rename). Layout rules: design §3 and docs/artifacts.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinetome/base/digest.h"
#include "kinetome/base/matrix.h"

namespace kinetome {

enum class ElementType { float32, float64, int32, int64, uint8, uint64, text };

/// How the shards of an artifact make up the logical dataset.
enum class Sharding {
    rows,      ///< rows of the shards, one after another in clip order
    constant,  ///< the same in every shard
};

struct DatasetSpec {
    std::string path;                ///< "/31j62d-…/pose_vectors"; parents are made
    ElementType type = ElementType::float32;
    std::vector<int64_t> row_shape;  ///< of one row; empty: a scalar a row; {31, 3}: n × 31 × 3
    std::string units;               ///< "cm", "rad", "frames", "1", …
    std::string description;
    std::string source;              ///< paper and section, or "" where there is none
    std::string frame;               ///< coordinate frame: "world, Y up", "facing frame", or ""
    Sharding sharding = Sharding::rows;

    bool operator==(const DatasetSpec&) const = default;
};

enum class Compression { none, gzip, blosc };
/// Throws UsageError for another name, or for blosc when its plugin is not installed.
Compression parse_compression(std::string_view name);

struct ArtifactHeader {
    std::string stage;       ///< file attribute `stage`
    Digest key;              ///< file attribute `key`
    int format_version = 1;  ///< file attribute `kinetome_format`
};

/// What is known of a file once it is closed; the ledger keeps it.
struct ArtifactRecord {
    std::string file_name;
    uint64_t bytes = 0;
    Digest hash;                              ///< of the file's bytes
    std::map<std::string, Digest> datasets;   ///< logical digest of each dataset, by path
};

/// Logical digest of a dataset, fed row by row: its path, type and row shape, then the values
/// (texts by content, without padding). Shards fed one after another give the dataset's digest.
class DatasetDigest {
  public:
    explicit DatasetDigest(const DatasetSpec& spec);
    void rows(const void* values, int64_t count);
    void texts(std::span<const std::string> values);
    Digest finish() const;

  private:
    Hasher hasher_;
    int64_t row_bytes_ = 0;
};

/// Writes one artifact. Until close() nothing exists under the final name; a writer destroyed
/// before that removes its temporary file. Thread-safe (HDF5 is called under one lock).
/// Errors: CreateError (permission, disk full), StoreError.
class ArtifactWriter {
  public:
    ArtifactWriter(std::filesystem::path path, const ArtifactHeader& header,
                   Compression compression = Compression::none);
    ~ArtifactWriter();
    ArtifactWriter(ArtifactWriter&&) noexcept;

    /// Makes a dataset; append rows to it afterwards, in any number of calls.
    void create(const DatasetSpec& spec);
    template <class T>
    void append(std::string_view dataset, std::span<const T> values) {
        append_values(dataset, element_type_of<T>(), values.data(), values.size());
    }
    void append(std::string_view dataset, const MatrixF& rows);
    void append(std::string_view dataset, const MatrixD& rows);
    void append_texts(std::string_view dataset, std::span<const std::string> values);

    /// create + append in one.
    template <class T>
    void write(const DatasetSpec& spec, std::span<const T> values) {
        create(spec);
        append<T>(spec.path, values);
    }
    void write_texts(const DatasetSpec& spec, std::span<const std::string> values);

    /// Flushes, syncs, hashes and renames.
    ArtifactRecord close();

    template <class T>
    static constexpr ElementType element_type_of();

  private:
    void append_values(std::string_view dataset, ElementType type, const void* values, size_t count);
    struct State;
    std::unique_ptr<State> state_;
};

/// Reads one artifact. The file's bytes are checked against `expected` before HDF5 sees them, once
/// per process and file. Errors: StoreError that names file and dataset.
class ArtifactReader {
  public:
    ArtifactReader(const std::filesystem::path& path, const Digest& expected);
    ~ArtifactReader();
    ArtifactReader(ArtifactReader&&) noexcept;

    const std::filesystem::path& path() const;
    const ArtifactHeader& header() const;
    /// All datasets, by path.
    const std::vector<DatasetSpec>& datasets() const;
    bool contains(std::string_view dataset) const;
    const DatasetSpec& spec(std::string_view dataset) const;
    int64_t rows(std::string_view dataset) const;

    /// Rows [first, first + count), flattened. T must be the stored type.
    template <class T>
    std::vector<T> read(std::string_view dataset, int64_t first, int64_t count) const {
        std::vector<T> values(value_count(dataset, ArtifactWriter::element_type_of<T>(), count));
        read_values(dataset, values.data(), first, count);
        return values;
    }
    template <class T>
    std::vector<T> read(std::string_view dataset) const {
        return read<T>(dataset, 0, rows(dataset));
    }
    /// Rows × (product of the row shape).
    MatrixF read_matrix(std::string_view dataset, int64_t first, int64_t count) const;
    MatrixD read_matrix_double(std::string_view dataset) const;
    std::vector<std::string> read_texts(std::string_view dataset) const;

    /// Feeds all rows of a dataset to a digest, block by block.
    void digest_rows(std::string_view dataset, DatasetDigest& digest) const;

  private:
    size_t value_count(std::string_view dataset, ElementType type, int64_t count) const;
    void read_values(std::string_view dataset, void* values, int64_t first, int64_t count) const;
    struct State;
    std::unique_ptr<State> state_;
};

template <class T>
constexpr ElementType ArtifactWriter::element_type_of() {
    if constexpr (std::is_same_v<T, float>) return ElementType::float32;
    if constexpr (std::is_same_v<T, double>) return ElementType::float64;
    if constexpr (std::is_same_v<T, int32_t>) return ElementType::int32;
    if constexpr (std::is_same_v<T, int64_t>) return ElementType::int64;
    if constexpr (std::is_same_v<T, uint8_t>) return ElementType::uint8;
    if constexpr (std::is_same_v<T, uint64_t>) return ElementType::uint64;
}

}  // namespace kinetome
