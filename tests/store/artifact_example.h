// A small artifact with a dataset of every type.
#pragma once

#include <cstring>
#include <string>
#include <variant>
#include <vector>

#include "kinetome/store/artifact.h"

namespace artifact_example {

using kinetome::DatasetSpec;
using kinetome::ElementType;

/// One dataset and all its values, flattened.
struct Data {
    DatasetSpec spec;
    std::variant<std::vector<float>, std::vector<double>, std::vector<int32_t>,
                 std::vector<int64_t>, std::vector<uint8_t>, std::vector<uint64_t>,
                 std::vector<std::string>>
        values;

    size_t size() const {
        return std::visit([](const auto& v) { return v.size(); }, values);
    }
    size_t rows() const { return size() / static_cast<size_t>(spec.values_per_row()); }
};

template <class T>
Data data(std::string path, std::vector<int64_t> row_shape, size_t rows) {
    Data made;
    made.spec.path = std::move(path);
    made.spec.row_shape = std::move(row_shape);
    if constexpr (std::is_same_v<T, std::string>) {
        made.spec.type = ElementType::text;
    } else {
        made.spec.type = kinetome::element_type_of<T>();
    }
    std::vector<T> values(rows * static_cast<size_t>(made.spec.values_per_row()));
    const uint64_t seed = kinetome::hash_name(made.spec.path) % 1000;
    for (size_t i = 0; i < values.size(); ++i) {
        if constexpr (std::is_same_v<T, std::string>) {
            values[i] = std::string(i % 5, 'x') + std::to_string(i % 7 == 0 ? 0 : i);
        } else {
            values[i] = static_cast<T>((i * 2654435761U + seed) % 1000003) / static_cast<T>(3);
        }
    }
    made.values = std::move(values);
    return made;
}

inline std::vector<Data> every_type(size_t rows) {
    std::vector<Data> all{data<float>("/31j62d/positions", {31, 3}, rows),
                          data<double>("/31j62d/model/mean", {15}, rows),
                          data<int32_t>("/letters", {}, rows),
                          data<int64_t>("/first", {}, rows),
                          data<uint8_t>("/kinds", {}, rows),
                          data<uint64_t>("/31j62d/accessible", {2}, rows),
                          data<std::string>("/names", {}, rows)};
    all[0].spec.units = "cm";
    all[0].spec.description = "joint positions";
    all[0].spec.source = "S3, section 3.1";
    all[0].spec.frame = "world, Y up";
    all[1].spec.sharding = kinetome::Sharding::constant;
    return all;
}

/// Appends rows [first, end).
inline void append(kinetome::ArtifactWriter& writer, const Data& data, size_t first, size_t end) {
    const auto row = static_cast<size_t>(data.spec.values_per_row());
    std::visit(
        [&]<class T>(const std::vector<T>& values) {
            const std::span<const T> part(values.data() + first * row, (end - first) * row);
            if constexpr (std::is_same_v<T, std::string>) {
                writer.append_texts(data.spec.path, part);
            } else {
                writer.append<T>(data.spec.path, part);
            }
        },
        data.values);
}

/// Writes all data, `piece` rows at a time (0: all at once).
inline kinetome::ArtifactRecord write(const std::filesystem::path& path,
                                      const std::vector<Data>& all, size_t piece = 0,
                                      const kinetome::WriteOptions& options = {}) {
    kinetome::ArtifactWriter writer(path, {.stage = "example", .key = kinetome::digest_of("key")},
                                    options);
    for (const Data& data : all) {
        writer.create(data.spec);
        const size_t step = piece > 0 ? piece : data.rows();
        for (size_t first = 0; first < data.rows(); first += step) {
            append(writer, data, first, std::min(first + step, data.rows()));
        }
    }
    return writer.close();
}

/// The values of a dataset, as bytes that can be compared (NaN too).
inline std::string bytes_of(const Data& data) {
    return std::visit(
        []<class T>(const std::vector<T>& values) {
            std::string bytes;
            if constexpr (std::is_same_v<T, std::string>) {
                for (const std::string& value : values) bytes += value + '\0';
            } else {
                bytes.assign(reinterpret_cast<const char*>(values.data()),
                             values.size() * sizeof(T));
            }
            return bytes;
        },
        data.values);
}

/// The dataset as the reader returns it.
inline Data read(const kinetome::ArtifactReader& reader, const Data& like) {
    Data found{reader.spec(like.spec.path), like.values};
    std::visit(
        [&]<class T>(std::vector<T>& values) {
            if constexpr (std::is_same_v<T, std::string>) {
                values = reader.read_texts(like.spec.path);
            } else {
                values = reader.read<T>(like.spec.path);
            }
        },
        found.values);
    return found;
}

}  // namespace artifact_example
