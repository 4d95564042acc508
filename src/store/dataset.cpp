#include "kinetome/store/dataset.h"

#include <stdexcept>

namespace kinetome {

std::string name_of(ElementType type) {
    switch (type) {
        case ElementType::float32:
            return "float32";
        case ElementType::float64:
            return "float64";
        case ElementType::int32:
            return "int32";
        case ElementType::int64:
            return "int64";
        case ElementType::uint8:
            return "uint8";
        case ElementType::uint64:
            return "uint64";
        case ElementType::text:
            return "text";
    }
    throw std::logic_error("an element type without a name");
}

int64_t element_bytes(ElementType type) {
    switch (type) {
        case ElementType::float32:
        case ElementType::int32:
            return 4;
        case ElementType::float64:
        case ElementType::int64:
        case ElementType::uint64:
            return 8;
        case ElementType::uint8:
            return 1;
        case ElementType::text:
            return 0;
    }
    throw std::logic_error("an element type without a size");
}

int64_t DatasetSpec::values_per_row() const {
    int64_t values = 1;
    for (const int64_t size : row_shape) values *= size;
    return values;
}

DatasetDigest::DatasetDigest(const DatasetSpec& spec)
    : row_bytes_(spec.values_per_row() * element_bytes(spec.type)) {
    hasher_.text(spec.path).text(name_of(spec.type)).number(spec.row_shape.size());
    for (const int64_t size : spec.row_shape) hasher_.number(static_cast<uint64_t>(size));
}

void DatasetDigest::rows(const void* values, int64_t count) {
    hasher_.bytes(values, static_cast<size_t>(count * row_bytes_));
}

void DatasetDigest::texts(std::span<const std::string> values) {
    for (const std::string& value : values) hasher_.text(value);
}

}  // namespace kinetome
