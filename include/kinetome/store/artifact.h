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
#include <utility>
#include <vector>

#include "kinetome/base/digest.h"
#include "kinetome/base/matrix.h"
#include "kinetome/store/compression.h"
#include "kinetome/store/dataset.h"
#include "kinetome/store/verified_files.h"

namespace kinetome {

/// Newest artifact format this program writes and reads.
inline constexpr int artifact_format = 1;

struct ArtifactHeader {
    std::string stage;                     ///< file attribute `stage`
    Digest key = {};                       ///< file attribute `key`
    int format_version = artifact_format;  ///< file attribute `kinetome_format`

    bool operator==(const ArtifactHeader&) const = default;
};

/// What is known of a file once it is closed; the ledger keeps it.
struct ArtifactRecord {
    std::string file_name;
    uint64_t bytes = 0;
    Digest hash;                             ///< of the file's bytes
    std::map<std::string, Digest> datasets;  ///< logical digest of each dataset, by path

    bool operator==(const ArtifactRecord&) const = default;
};

/// Bytes that a dataset of so many rows takes in an artifact that is not compressed: its values in
/// whole chunks (once it outgrows the first), and its description.
uint64_t dataset_bytes(int64_t row_bytes, int64_t rows);

/// How an artifact is written; its content does not depend on it.
struct WriteOptions {
    WriteOptions(Compression how = Compression::none, std::filesystem::path scratch = {})
        : compression(how), node_scratch(std::move(scratch)) {}

    Compression compression;
    /// Existing folder, on a disk nearer than the artifact's, where the file is put together before
    /// it is copied beside its place, and the copy checked. "": it is put together beside its
    /// place.
    std::filesystem::path node_scratch;
};

/// Writes one artifact. Until close() nothing exists under the final name; a writer destroyed
/// before that removes its temporary file. The file's bytes depend on the rows and on the order in
/// which datasets fill up, not on how a dataset's rows are split among calls.
/// A writer belongs to one thread; different writers may work at the same time.
/// Throws CreateError (permission, disk full), after which only destruction is allowed.
class ArtifactWriter {
  public:
    /// The folder must exist.
    ArtifactWriter(std::filesystem::path path, const ArtifactHeader& header,
                   const WriteOptions& options = {});
    ~ArtifactWriter();
    ArtifactWriter(ArtifactWriter&&) noexcept;
    ArtifactWriter& operator=(ArtifactWriter&&) noexcept;

    /// Makes a dataset; append rows to it afterwards, in any number of calls.
    void create(const DatasetSpec& spec);
    /// Whole rows, flattened.
    template <class T>
    void append(std::string_view dataset, std::span<const T> values) {
        append_values(dataset, element_type_of<T>(), values.data(), values.size());
    }
    void append(std::string_view dataset, const MatrixFView& rows);
    void append(std::string_view dataset, const MatrixDView& rows);
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

  private:
    void append_values(std::string_view dataset, ElementType type, const void* values,
                       size_t count);
    template <class View>
    void append_matrix(std::string_view dataset, const View& rows);

    struct State;
    std::unique_ptr<State> state_;
};

/// Reads one artifact, whose bytes are checked against `expected` before HDF5 sees them.
/// Thread-safe. Throws StoreError that names file and dataset.
class ArtifactReader {
  public:
    ArtifactReader(const std::filesystem::path& path, const Digest& expected);
    /// Hashes the file only when `verified` does not know it yet.
    ArtifactReader(const std::filesystem::path& path, const Digest& expected,
                   VerifiedFiles& verified);
    ~ArtifactReader();
    ArtifactReader(ArtifactReader&&) noexcept;
    ArtifactReader& operator=(ArtifactReader&&) noexcept;

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
        std::vector<T> values(value_count(dataset, element_type_of<T>(), first, count));
        read_values(dataset, values.data(), first, count);
        return values;
    }
    template <class T>
    std::vector<T> read(std::string_view dataset) const {
        return read<T>(dataset, 0, rows(dataset));
    }
    /// Rows × (product of the row shape).
    MatrixF read_matrix(std::string_view dataset, int64_t first, int64_t count) const;
    MatrixF read_matrix(std::string_view dataset) const;
    MatrixD read_matrix_double(std::string_view dataset) const;
    std::vector<std::string> read_texts(std::string_view dataset) const;

    /// Feeds all rows of a dataset to a digest, block by block.
    void digest_rows(std::string_view dataset, DatasetDigest& digest) const;

  private:
    size_t value_count(std::string_view dataset, ElementType type, int64_t first,
                       int64_t count) const;
    void read_values(std::string_view dataset, void* values, int64_t first, int64_t count) const;

    struct State;
    std::unique_ptr<State> state_;
};

/// Datasets of a damaged file whose values cannot be read; none when the damage lies elsewhere (in
/// the file's structure, its attributes or unused bytes). Works in a process of its own, so that
/// whatever damaged structure does to HDF5 is done there.
std::vector<std::string> unreadable_datasets(const std::filesystem::path& path);

}  // namespace kinetome
