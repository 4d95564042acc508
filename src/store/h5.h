// HDF5, as far as artifacts need it. Only src/store/h5_*.cpp call the library; every call is
// checked and runs under one lock of the process (HDF5's state is global, and locking single calls
// does not protect a sequence of them); callers see plain buffers.
//
// Throws StoreError with HDF5's own explanation, and CreateError when the disk refuses a write.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "kinetome/store/compression.h"
#include "kinetome/store/dataset.h"

namespace kinetome::h5 {

bool has_blosc();

struct Attribute {
    std::string name;
    std::variant<int64_t, std::string> value;
};

/// How a dataset lies in the file.
struct Layout {
    ElementType type = ElementType::float32;
    int64_t text_width = 0;  ///< bytes of one text, padded with zero bytes
    std::vector<int64_t> row_shape;
    int64_t chunk_rows = 1;
    std::optional<int64_t> rows;  ///< final number, when known beforehand
    Compression compression = Compression::none;
};

class OutputFile {
  public:
    /// A new file at `path`; messages name it `shown`.
    OutputFile(const std::filesystem::path& path, const std::filesystem::path& shown);
    /// Without close(): drops what was not written yet.
    ~OutputFile();

    /// Attributes of an object ("/" is the file's), set once.
    void set_attributes(const std::string& object, std::span<const Attribute> attributes);
    /// Makes parent groups too.
    void create_dataset(const std::string& path, const Layout& layout);
    /// Rows from `first` on; the dataset grows to hold them.
    void write_rows(const std::string& dataset, int64_t first, int64_t count, const void* values);
    void close();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

class InputFile {
  public:
    explicit InputFile(const std::filesystem::path& path);
    ~InputFile();

    /// Nothing when the object has no such attribute.
    std::optional<std::string> text_attribute(const std::string& object,
                                              const std::string& name) const;
    std::optional<int64_t> number_attribute(const std::string& object,
                                            const std::string& name) const;
    /// Paths in order of name.
    std::vector<std::string> datasets() const;
    /// Opens a dataset when first asked for it. `rows` is set.
    const Layout& layout(const std::string& dataset) const;
    void read_rows(const std::string& dataset, int64_t first, int64_t count, void* values) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace kinetome::h5
