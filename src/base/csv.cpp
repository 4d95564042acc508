#include "kinetome/base/csv.h"

#include "kinetome/base/error.h"

namespace kinetome {
namespace {

constexpr std::string_view formula_starts = "=+-@\t\r";

bool begins_like_formula(std::string_view text) {
    return !text.empty() && formula_starts.find(text.front()) != std::string_view::npos;
}

/// Reads one record after another.
class CsvReader {
  public:
    CsvReader(std::string_view text, const std::string& path) : text_(text), path_(path) {}

    std::vector<CsvRecord> read_all() {
        std::vector<CsvRecord> records;
        while (at_ < text_.size()) {
            CsvRecord record;
            record.line = line_;
            do {
                record.fields.push_back(read_field());
            } while (skip(","));
            skip("\r\n") || skip("\n");
            ++line_;
            const bool empty = record.fields.size() == 1 && record.fields.front().empty();
            if (!empty) records.push_back(std::move(record));
        }
        return records;
    }

  private:
    bool skip(std::string_view token) {
        if (!text_.substr(at_).starts_with(token)) return false;
        at_ += token.size();
        return true;
    }

    bool at_field_end() const {
        const std::string_view rest = text_.substr(at_);
        return rest.empty() || rest.front() == ',' || rest.front() == '\n' ||
               rest.starts_with("\r\n");
    }

    std::string read_field() {
        if (skip("\"")) return read_quoted();
        const size_t first = at_;
        while (!at_field_end()) {
            if (text_[at_] == '"')
                throw InputError::at_line(path_, line_,
                                          "expected a field in quotes, found a quote inside it");
            ++at_;
        }
        return std::string(text_.substr(first, at_ - first));
    }

    std::string read_quoted() {
        const int64_t opened = line_;
        std::string field;
        for (;;) {
            if (at_ == text_.size())
                throw InputError::at_line(path_, opened, "a quote is opened but not closed");
            if (skip("\"\"")) {
                field += '"';
            } else if (skip("\"")) {
                break;
            } else {
                line_ += text_[at_] == '\n';
                field += text_[at_++];
            }
        }
        if (!at_field_end())
            throw InputError::at_line(path_, line_, "expected a comma after a closing quote");
        return field;
    }

    std::string_view text_;
    const std::string& path_;
    size_t at_ = 0;
    int64_t line_ = 1;
};

}  // namespace

void append_csv_line(std::string& text, const std::vector<std::string>& fields) {
    bool first = true;
    for (const std::string& field : fields) {
        if (!first) text += ',';
        first = false;
        if (field.find_first_of(",\"\r\n") == std::string::npos) {
            text += field;
            continue;
        }
        text += '"';
        for (const char character : field) {
            if (character == '"') text += '"';
            text += character;
        }
        text += '"';
    }
    text += '\n';
}

std::string csv_text(std::string_view text) {
    return begins_like_formula(text) ? "'" + std::string(text) : std::string(text);
}

std::string from_csv_text(std::string_view field) {
    const bool guarded = field.starts_with('\'') && begins_like_formula(field.substr(1));
    return std::string(guarded ? field.substr(1) : field);
}

std::vector<CsvRecord> parse_csv(std::string_view text, const std::string& path) {
    return CsvReader(text, path).read_all();
}

}  // namespace kinetome
