// Writes the datasets of one group of an artifact.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kinetome/base/matrix.h"
#include "kinetome/store/artifact.h"

namespace kinetome {

class GroupWriter {
  public:
    /// `file` outlives it.
    GroupWriter(ArtifactWriter& file, std::string group) : file_(file), group_(std::move(group)) {}

    template <class T>
    void values(const char* name, const char* units, const char* description, const char* source,
                const std::vector<T>& values) const {
        file_.write<T>(spec(name, element_type_of<T>(), {}, units, description, source), values);
    }
    void values(const char* name, const char* units, const char* description, const char* source,
                const VectorD& vector) const {
        values(name, units, description, source, std::vector<double>(vector.begin(), vector.end()));
    }
    /// Rows of some shape; nothing where a row has no values.
    void rows(const char* name, const char* units, const char* description, const char* source,
              std::vector<int64_t> shape, std::span<const double> values) const {
        const DatasetSpec dataset =
            spec(name, ElementType::float64, std::move(shape), units, description, source);
        if (dataset.values_per_row() > 0) file_.write<double>(dataset, values);
    }
    void rows(const char* name, const char* units, const char* description, const char* source,
              const MatrixF& rows) const {
        file_.create(spec(name, ElementType::float32, {rows.cols()}, units, description, source));
        file_.append(group_ + "/" + name, rows);
    }
    void texts(const char* name, const char* description, const char* source,
               const std::vector<std::string>& texts) const {
        file_.write_texts(spec(name, ElementType::text, {}, "1", description, source), texts);
    }

  private:
    DatasetSpec spec(const char* name, ElementType type, std::vector<int64_t> shape,
                     const char* units, const char* description, const char* source) const {
        return {group_ + "/" + name, type, std::move(shape), units, description, source, "", {}};
    }

    ArtifactWriter& file_;
    std::string group_;
};

}  // namespace kinetome
