// What every call of HDF5 needs: the lock, checked results, owned identifiers, types and shapes.
#pragma once

#include <fmt/format.h>
#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "backing_file.h"
#include "h5.h"
#include "kinetome/base/error.h"

namespace kinetome::h5 {

inline constexpr H5Z_filter_t blosc_filter = 32001;
inline const std::string whole_file = "the file";

/// HDF5's state is global, so its lock is.
std::mutex& library_mutex();

/// The right to call HDF5. Its habit of printing errors is off meanwhile.
class Session {
  public:
    Session() : lock_(library_mutex()) {
        H5Eget_auto2(H5E_DEFAULT, &print_, &print_data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    ~Session() { H5Eset_auto2(H5E_DEFAULT, print_, print_data_); }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

  private:
    std::lock_guard<std::mutex> lock_;
    H5E_auto2_t print_ = nullptr;
    void* print_data_ = nullptr;
};

/// The innermost entry of HDF5's error stack, where the cause is; clears the stack.
std::string explanation();

/// What is being done, for messages.
struct Context {
    const char* action;
    const std::filesystem::path& file;
    const std::string& object;
};

template <class Result>
Result check(Result result, const Context& context) {
    if (result >= 0) return result;
    throw StoreError(fmt::format("cannot {} {} in {}: {}", context.action, context.object,
                                 context.file.string(), explanation()));
}

/// Owns an HDF5 identifier.
class Handle {
  public:
    using Close = herr_t (*)(hid_t);
    Handle() = default;
    Handle(hid_t id, Close closer) : id_(id), close_(closer) {}
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(id_, other.id_);
        std::swap(close_, other.close_);
        return *this;
    }
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    hid_t id() const { return id_; }
    herr_t close() { return close_(std::exchange(id_, -1)); }

  private:
    hid_t id_ = -1;
    Close close_ = nullptr;
};

/// Properties of a file that is reached through `backing`.
Handle file_access(BackingFile* backing, const std::filesystem::path& file);

/// In the file and in memory alike: this program runs on little-endian machines only.
hid_t numeric_type(ElementType type);
/// Fixed width, padded with zero bytes, UTF-8.
Handle text_type(int64_t width, const Context& context);
Handle value_type(ElementType type, int64_t text_width, const Context& context);

/// Sizes of `rows` rows.
std::vector<hsize_t> extent(int64_t rows, const std::vector<int64_t>& row_shape);

struct RowSelection {
    Handle file;
    Handle memory;
};

/// Rows [first, first + count) of a dataset, and a buffer that holds them.
RowSelection select_rows(hid_t dataset, int64_t first, int64_t count,
                         const std::vector<int64_t>& row_shape, const Context& context);

struct OpenDataset {
    Handle dataset;
    Handle type;
    Layout layout;
};

}  // namespace kinetome::h5
