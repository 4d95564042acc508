#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "h5.h"
#include "kinetome/base/error.h"
#include "kinetome/store/artifact.h"

namespace kinetome {
namespace {

namespace fs = std::filesystem;

ArtifactHeader read_header(const h5::InputFile& file, const fs::path& path) {
    const auto format = file.number_attribute("/", "kinetome_format");
    if (format && *format > artifact_format) {
        throw StoreError(fmt::format(
            "{} was made by a newer Kinetome (format {}, this one knows up to {}); use that one",
            path.string(), *format, artifact_format));
    }
    const auto stage = file.text_attribute("/", "stage");
    const auto key = file.text_attribute("/", "key");
    if (!format || !stage || !key) {
        throw StoreError(path.string() + " is no artifact of Kinetome: it has no header");
    }
    return {.stage = *stage,
            .key = Digest::from_hex(*key),
            .format_version = static_cast<int>(*format)};
}

DatasetSpec read_spec(const h5::InputFile& file, const std::string& dataset) {
    const h5::Layout& layout = file.layout(dataset);
    const auto text = [&](const char* name) {
        return file.text_attribute(dataset, name).value_or("");
    };
    return {.path = dataset,
            .type = layout.type,
            .row_shape = layout.row_shape,
            .units = text("units"),
            .description = text("description"),
            .source = text("source"),
            .frame = text("frame"),
            .sharding = text("sharding") == "constant" ? Sharding::constant : Sharding::rows};
}

std::vector<std::string> split_texts(const std::vector<char>& cells, int64_t width) {
    std::vector<std::string> texts;
    texts.reserve(cells.size() / static_cast<size_t>(width));
    for (auto cell = cells.begin(); cell != cells.end(); cell += width) {
        texts.emplace_back(cell, std::find(cell, cell + width, '\0'));
    }
    return texts;
}

const fs::path& verified(const fs::path& path, const Digest& expected) {
    require_hash(path, expected);
    return path;
}

const fs::path& verified(const fs::path& path, const Digest& expected, VerifiedFiles& files) {
    files.require(path, expected);
    return path;
}

}  // namespace

struct ArtifactReader::State {
    fs::path path;
    h5::InputFile file;
    ArtifactHeader header;
    std::vector<DatasetSpec> datasets;

    explicit State(const fs::path& file_path)
        : path(file_path), file(path), header(read_header(file, path)) {
        for (const std::string& dataset : file.datasets()) {
            datasets.push_back(read_spec(file, dataset));
        }
    }

    const DatasetSpec* find(std::string_view dataset) const {
        const auto found = std::find_if(datasets.begin(), datasets.end(),
                                        [&](const auto& spec) { return spec.path == dataset; });
        return found == datasets.end() ? nullptr : &*found;
    }

    /// The layout of a dataset that must have this type.
    const h5::Layout& layout(const DatasetSpec& spec, ElementType type) const {
        if (spec.type == type) return file.layout(spec.path);
        throw StoreError(fmt::format("{} in {} holds {}, {} was expected", spec.path, path.string(),
                                     name_of(spec.type), name_of(type)));
    }

    std::vector<std::string> texts(const DatasetSpec& spec, int64_t first, int64_t count) const {
        const int64_t width = file.layout(spec.path).text_width;
        std::vector<char> cells(static_cast<size_t>(count * width));
        file.read_rows(spec.path, first, count, cells.data());
        return split_texts(cells, width);
    }
};

ArtifactReader::ArtifactReader(const fs::path& path, const Digest& expected)
    : state_(std::make_unique<State>(verified(path, expected))) {}

ArtifactReader::ArtifactReader(const fs::path& path, const Digest& expected, VerifiedFiles& files)
    : state_(std::make_unique<State>(verified(path, expected, files))) {}

ArtifactReader::~ArtifactReader() = default;
ArtifactReader::ArtifactReader(ArtifactReader&&) noexcept = default;
ArtifactReader& ArtifactReader::operator=(ArtifactReader&&) noexcept = default;

const fs::path& ArtifactReader::path() const {
    return state_->path;
}
const ArtifactHeader& ArtifactReader::header() const {
    return state_->header;
}
const std::vector<DatasetSpec>& ArtifactReader::datasets() const {
    return state_->datasets;
}

bool ArtifactReader::contains(std::string_view dataset) const {
    return state_->find(dataset) != nullptr;
}

const DatasetSpec& ArtifactReader::spec(std::string_view dataset) const {
    if (const DatasetSpec* found = state_->find(dataset)) return *found;
    throw StoreError(fmt::format(
        "{} has no dataset {}: was it made by another version? `kinetome reindex` makes it again",
        state_->path.string(), dataset));
}

int64_t ArtifactReader::rows(std::string_view dataset) const {
    return *state_->file.layout(spec(dataset).path).rows;
}

size_t ArtifactReader::value_count(std::string_view dataset, ElementType type, int64_t first,
                                   int64_t count) const {
    const DatasetSpec& found = spec(dataset);
    const int64_t rows = *state_->layout(found, type).rows;
    if (first < 0 || count < 0 || first > rows || count > rows - first) {
        throw StoreError(fmt::format("{} in {} has {} rows: {} from row {} on do not exist",
                                     dataset, state_->path.string(), rows, count, first));
    }
    return static_cast<size_t>(count * found.values_per_row());
}

void ArtifactReader::read_values(std::string_view dataset, void* values, int64_t first,
                                 int64_t count) const {
    state_->file.read_rows(std::string(dataset), first, count, values);
}

MatrixF ArtifactReader::read_matrix(std::string_view dataset, int64_t first, int64_t count) const {
    value_count(dataset, ElementType::float32, first, count);
    MatrixF matrix(count, spec(dataset).values_per_row());
    read_values(dataset, matrix.data(), first, count);
    return matrix;
}

MatrixF ArtifactReader::read_matrix(std::string_view dataset) const {
    return read_matrix(dataset, 0, rows(dataset));
}

MatrixD ArtifactReader::read_matrix_double(std::string_view dataset) const {
    const int64_t count = rows(dataset);
    value_count(dataset, ElementType::float64, 0, count);
    MatrixD matrix(count, spec(dataset).values_per_row());
    read_values(dataset, matrix.data(), 0, count);
    return matrix;
}

std::vector<std::string> ArtifactReader::read_texts(std::string_view dataset) const {
    const DatasetSpec& found = spec(dataset);
    return state_->texts(found, 0, *state_->layout(found, ElementType::text).rows);
}

void ArtifactReader::digest_rows(std::string_view dataset, DatasetDigest& digest) const {
    const DatasetSpec& found = spec(dataset);
    const h5::Layout& layout = state_->file.layout(found.path);
    const int64_t row_bytes = found.values_per_row() * element_bytes(found.type);
    std::vector<char> block(static_cast<size_t>(layout.chunk_rows * row_bytes));
    for (int64_t first = 0; first < *layout.rows; first += layout.chunk_rows) {
        const int64_t count = std::min(layout.chunk_rows, *layout.rows - first);
        if (found.type == ElementType::text) {
            digest.texts(state_->texts(found, first, count));
        } else {
            state_->file.read_rows(found.path, first, count, block.data());
            digest.rows(block.data(), count);
        }
    }
}

}  // namespace kinetome
