#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "h5.h"
#include "kinetome/base/error.h"
#include "kinetome/base/file.h"
#include "kinetome/store/artifact.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

/// Large enough that a chunk's cost is its bytes, small enough for HDF5's default chunk cache.
constexpr int64_t chunk_bytes = 512 * 1024;

/// Depends on the dataset's type alone, so that equal content gives equal files.
int64_t rows_of_a_chunk(int64_t row_bytes) {
    const int64_t most = std::max<int64_t>(1, chunk_bytes / row_bytes);
    return static_cast<int64_t>(std::bit_floor(static_cast<uint64_t>(most)));
}

void require_valid(const DatasetSpec& spec) {
    const bool whole_path = spec.path.size() > 1 && spec.path.front() == '/' &&
                            spec.path.back() != '/' && spec.path.find("//") == std::string::npos &&
                            spec.path.find('\0') == std::string::npos;
    const bool sizes_positive = std::all_of(spec.row_shape.begin(), spec.row_shape.end(),
                                            [](int64_t size) { return size > 0; });
    const bool text_is_scalar = spec.type != ElementType::text || spec.row_shape.empty();
    if (!whole_path || !sizes_positive || !text_is_scalar) {
        throw std::logic_error("an artifact cannot hold a dataset like " + spec.path);
    }
}

std::vector<h5::Attribute> attributes_of(const DatasetSpec& spec) {
    return {{"units", spec.units},
            {"description", spec.description},
            {"source", spec.source},
            {"frame", spec.frame},
            {"sharding", std::string(spec.sharding == Sharding::rows ? "rows" : "constant")}};
}

/// A dataset being written. Its rows wait here until they fill a chunk: what reaches HDF5 does not
/// depend on how callers split them, and a dataset that never fills one takes no more than it
/// needs.
class Column {
  public:
    Column(DatasetSpec spec, Compression compression)
        : spec_(std::move(spec)), digest_(spec_), compression_(compression) {
        if (spec_.type == ElementType::text) return;
        row_bytes_ = spec_.values_per_row() * element_bytes(spec_.type);
        chunk_rows_ = rows_of_a_chunk(row_bytes_);
    }

    const DatasetSpec& spec() const { return spec_; }
    Digest digest() const { return digest_.finish(); }

    void append(h5::OutputFile& file, const std::byte* values, int64_t rows) {
        digest_.rows(values, rows);
        while (rows > 0) {
            const int64_t taken = std::min(rows, chunk_rows_ - waiting_rows());
            waiting_.insert(waiting_.end(), values, values + taken * row_bytes_);
            values += taken * row_bytes_;
            rows -= taken;
            if (waiting_rows() == chunk_rows_) flush(file);
        }
    }

    void append(std::span<const std::string> texts) {
        digest_.texts(texts);
        texts_.insert(texts_.end(), texts.begin(), texts.end());
    }

    void finish(h5::OutputFile& file) {
        if (spec_.type == ElementType::text) pad_texts();
        if (!created_) {
            chunk_rows_ = std::clamp<int64_t>(waiting_rows(), 1, chunk_rows_);
            create(file, waiting_rows());
        }
        while (!waiting_.empty()) flush(file);
    }

  private:
    int64_t waiting_rows() const { return static_cast<int64_t>(waiting_.size()) / row_bytes_; }

    /// `rows`: their final number, 0 when unknown (HDF5 refuses chunks that are larger than that).
    void create(h5::OutputFile& file, int64_t rows) {
        file.create_dataset(spec_.path, {.type = spec_.type,
                                         .text_width = row_bytes_,
                                         .row_shape = spec_.row_shape,
                                         .chunk_rows = chunk_rows_,
                                         .rows = rows > 0 ? std::optional(rows) : std::nullopt,
                                         .compression = compression_});
        file.set_attributes(spec_.path, attributes_of(spec_));
        created_ = true;
    }

    /// Writes the first waiting rows, at most a chunk of them.
    void flush(h5::OutputFile& file) {
        if (!created_) create(file, 0);
        const int64_t rows = std::min(waiting_rows(), chunk_rows_);
        file.write_rows(spec_.path, written_rows_, rows, waiting_.data());
        waiting_.erase(waiting_.begin(), waiting_.begin() + rows * row_bytes_);
        written_rows_ += rows;
    }

    /// The width of all texts is known only now.
    void pad_texts() {
        row_bytes_ = 1;
        for (const std::string& text : texts_) {
            row_bytes_ = std::max(row_bytes_, static_cast<int64_t>(text.size()));
        }
        chunk_rows_ = rows_of_a_chunk(row_bytes_);
        waiting_.resize(texts_.size() * static_cast<size_t>(row_bytes_));
        auto* cell = reinterpret_cast<char*>(waiting_.data());
        for (const std::string& text : texts_) {
            text.copy(cell, text.size());
            cell += row_bytes_;
        }
    }

    DatasetSpec spec_;
    DatasetDigest digest_;
    Compression compression_;
    int64_t row_bytes_ = 1;
    int64_t chunk_rows_ = 1;
    int64_t written_rows_ = 0;
    std::vector<std::byte> waiting_;
    std::vector<std::string> texts_;
    bool created_ = false;
};

/// A name for an unfinished file that no other writer of any process uses.
fs::path temporary_in(const fs::path& folder, const fs::path& file_name) {
    for (int attempt = 0;; ++attempt) {
        fs::path temporary =
            folder / fmt::format(".{}.writing-{}-{}", file_name.string(), ::getpid(), attempt);
        if (!fs::exists(fs::symlink_status(temporary))) return temporary;
    }
}

/// A finished file, copied beside `path` from another disk; its bytes are on the disk and have the
/// hash.
fs::path copy_beside(const fs::path& path, const fs::path& file, const Digest& hash) {
    fs::path copy = temporary_in(path.parent_path(), path.filename());
    try {
        copy_to_new_file(file, copy);
        fsync_path(copy);
        require_hash(copy, hash);
    } catch (...) {
        ::unlink(copy.c_str());
        throw;
    }
    return copy;
}

}  // namespace

struct ArtifactWriter::State {
    fs::path path;
    WriteOptions options;
    fs::path temporary;
    std::unique_ptr<h5::OutputFile> file;
    std::map<std::string, Column, std::less<>> columns;
    bool renamed = false;

    State(fs::path target, const WriteOptions& how)
        : path(std::move(target)),
          options(how),
          temporary(temporary_in(folder(), path.filename())) {
        file = std::make_unique<h5::OutputFile>(temporary, folder() / path.filename());
    }
    ~State() {
        file.reset();
        if (!renamed) ::unlink(temporary.c_str());
    }

    bool is_elsewhere() const { return !options.node_scratch.empty(); }
    /// Where the file is put together.
    fs::path folder() const { return is_elsewhere() ? options.node_scratch : path.parent_path(); }

    /// Leaves the disk that the file was put together on.
    void move_beside(const Digest& hash) {
        fs::path copy = copy_beside(path, temporary, hash);
        ::unlink(temporary.c_str());
        temporary = std::move(copy);
    }

    Column& column(std::string_view dataset, ElementType type) {
        const auto found = columns.find(dataset);
        if (found == columns.end() || found->second.spec().type != type) {
            throw std::logic_error(fmt::format("{} has no dataset {} of type {}", path.string(),
                                               dataset, name_of(type)));
        }
        return found->second;
    }
};

uint64_t dataset_bytes(int64_t row_bytes, int64_t rows) {
    constexpr int64_t description_bytes = 512;  // header, attributes, entries of chunk and group
    const int64_t chunk = rows_of_a_chunk(row_bytes);
    const int64_t stored = rows > chunk ? (rows + chunk - 1) / chunk * chunk : rows;
    return static_cast<uint64_t>(stored * row_bytes + description_bytes);
}

ArtifactWriter::ArtifactWriter(fs::path path, const ArtifactHeader& header,
                               const WriteOptions& options)
    : state_(std::make_unique<State>(std::move(path), options)) {
    const std::vector<h5::Attribute> attributes{{"kinetome_format", int64_t{header.format_version}},
                                                {"stage", header.stage},
                                                {"key", header.key.hex()}};
    state_->file->set_attributes("/", attributes);
}

ArtifactWriter::~ArtifactWriter() = default;
ArtifactWriter::ArtifactWriter(ArtifactWriter&&) noexcept = default;
ArtifactWriter& ArtifactWriter::operator=(ArtifactWriter&&) noexcept = default;

void ArtifactWriter::create(const DatasetSpec& spec) {
    require_valid(spec);
    const bool added =
        state_->columns.try_emplace(spec.path, spec, state_->options.compression).second;
    if (!added) throw std::logic_error("dataset " + spec.path + " is made twice");
}

void ArtifactWriter::append_values(std::string_view dataset, ElementType type, const void* values,
                                   size_t count) {
    Column& column = state_->column(dataset, type);
    const auto row = static_cast<size_t>(column.spec().values_per_row());
    if (count % row != 0) {
        throw std::logic_error(fmt::format("{} values are no whole rows of {}", count, dataset));
    }
    column.append(*state_->file, static_cast<const std::byte*>(values),
                  static_cast<int64_t>(count / row));
}

template <class View>
void ArtifactWriter::append_matrix(std::string_view dataset, const View& rows) {
    using Scalar = typename View::Scalar;
    const auto columns = static_cast<size_t>(rows.cols());
    if (rows.outerStride() == rows.cols()) {
        append_values(dataset, element_type_of<Scalar>(), rows.data(),
                      static_cast<size_t>(rows.rows()) * columns);
        return;
    }
    for (Eigen::Index row = 0; row < rows.rows(); ++row) {
        append_values(dataset, element_type_of<Scalar>(), rows.data() + row * rows.outerStride(),
                      columns);
    }
}

void ArtifactWriter::append(std::string_view dataset, const MatrixFView& rows) {
    append_matrix(dataset, rows);
}

void ArtifactWriter::append(std::string_view dataset, const MatrixDView& rows) {
    append_matrix(dataset, rows);
}

void ArtifactWriter::append_texts(std::string_view dataset, std::span<const std::string> values) {
    for (const std::string& value : values) {
        if (value.find('\0') != std::string::npos) {
            throw std::logic_error(fmt::format("a text of {} holds a zero byte", dataset));
        }
    }
    state_->column(dataset, ElementType::text).append(values);
}

void ArtifactWriter::write_texts(const DatasetSpec& spec, std::span<const std::string> values) {
    create(spec);
    append_texts(spec.path, values);
}

ArtifactRecord ArtifactWriter::close() {
    ArtifactRecord record;
    record.file_name = state_->path.filename().string();
    for (auto& [path, column] : state_->columns) {
        column.finish(*state_->file);
        record.datasets.emplace(path, column.digest());
    }
    state_->file->close();
    if (!state_->is_elsewhere()) fsync_path(state_->temporary);
    record.hash = digest_file(state_->temporary, &record.bytes);
    if (state_->is_elsewhere()) state_->move_beside(record.hash);
    if (::rename(state_->temporary.c_str(), state_->path.c_str()) != 0) {
        throw create_error("create", state_->path, errno);
    }
    state_->renamed = true;
    fsync_directory(state_->path.has_parent_path() ? state_->path.parent_path() : ".");
    return record;
}

}  // namespace kinetome
