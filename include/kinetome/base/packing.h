// Values as bytes and back, in the order they are put: for messages between ranks and checkpoints.
// Native byte order: both ends are the same build on the same kind of machine.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "kinetome/base/matrix.h"

namespace kinetome {

/// Numbers, arrays and texts, one behind the other.
class Packer {
  public:
    template <class T>
    requires std::is_arithmetic_v<T> Packer& put(T value) { return append(&value, sizeof value); }
    template <class T>
    requires std::is_arithmetic_v<T> Packer& put(std::span<const T> values) {
        put(static_cast<uint64_t>(values.size()));
        return append(values.data(), values.size_bytes());
    }
    Packer& put(std::string_view text) { return put(std::span(text.data(), text.size())); }

    const std::string& bytes() const { return bytes_; }
    std::string take() { return std::exchange(bytes_, {}); }

  private:
    Packer& append(const void* data, size_t size) {
        bytes_.append(static_cast<const char*>(data), size);
        return *this;
    }
    std::string bytes_;
};

/// Gets back in the same order what a Packer put. Throws std::out_of_range when there is less.
class Unpacker {
  public:
    explicit Unpacker(std::string bytes) : bytes_(std::move(bytes)) {}

    template <class T>
    requires std::is_arithmetic_v<T> T get() {
        T value;
        take(&value, sizeof value);
        return value;
    }
    template <class T>
    requires std::is_arithmetic_v<T> std::vector<T> get_all() {
        const auto count = get<uint64_t>();
        if (count > left() / sizeof(T)) throw std::out_of_range("packed bytes end too early");
        std::vector<T> values(count);
        take(values.data(), count * sizeof(T));
        return values;
    }
    std::string get_text() {
        const auto text = get_all<char>();
        return {text.begin(), text.end()};
    }
    size_t left() const { return bytes_.size() - at_; }

  private:
    void take(void* data, size_t size) {
        if (size > left()) throw std::out_of_range("packed bytes end too early");
        if (size > 0) std::memcpy(data, bytes_.data() + at_, size);
        at_ += size;
    }
    std::string bytes_;
    size_t at_ = 0;
};

/// A type that can travel has pack(Packer&, const T&) and unpack(Unpacker&, T&) beside it.
template <class T>
requires std::is_arithmetic_v<T>
void pack(Packer& out, const T& value) {
    out.put(value);
}
template <class T>
requires std::is_arithmetic_v<T>
void unpack(Unpacker& in, T& value) {
    value = in.get<T>();
}
template <class Scalar>
void pack(Packer& out, const RowMatrix<Scalar>& matrix) {
    out.template put<int64_t>(matrix.rows()).template put<int64_t>(matrix.cols());
    out.put(std::span<const Scalar>(matrix.data(), static_cast<size_t>(matrix.size())));
}
template <class Scalar>
void unpack(Unpacker& in, RowMatrix<Scalar>& matrix) {
    const auto rows = in.get<int64_t>();
    const auto columns = in.get<int64_t>();
    const auto values = in.get_all<Scalar>();
    if (rows < 0 || columns < 0 || static_cast<uint64_t>(rows * columns) != values.size()) {
        throw std::out_of_range("packed bytes are not a matrix");
    }
    matrix = Eigen::Map<const RowMatrix<Scalar>>(values.data(), rows, columns);
}
inline void pack(Packer& out, const VectorD& vector) {
    out.put(std::span<const double>(vector.data(), static_cast<size_t>(vector.size())));
}
inline void unpack(Unpacker& in, VectorD& vector) {
    const auto values = in.get_all<double>();
    vector = Eigen::Map<const VectorD>(values.data(), static_cast<Eigen::Index>(values.size()));
}
template <class T>
requires std::is_arithmetic_v<T>
void pack(Packer& out, const std::vector<T>& values) {
    out.put(std::span<const T>(values));
}
template <class T>
requires std::is_arithmetic_v<T>
void unpack(Unpacker& in, std::vector<T>& values) {
    values = in.get_all<T>();
}

template <class T>
void pack(Packer& out, const std::optional<T>& value) {
    out.put<uint8_t>(value.has_value());
    if (value) pack(out, *value);
}
template <class T>
void unpack(Unpacker& in, std::optional<T>& value) {
    value.reset();
    if (in.get<uint8_t>()) unpack(in, value.emplace());
}

/// One value as a message, and back.
template <class T>
std::string packed(const T& value) {
    Packer out;
    pack(out, value);
    return out.take();
}
template <class T>
T unpacked(std::string bytes) {
    Unpacker in(std::move(bytes));
    T value;
    unpack(in, value);
    return value;
}

}  // namespace kinetome
