#include "kinetome/formats/csv_table.h"

#include <charconv>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"

namespace kinetome {

std::vector<CsvRecord> parse_csv_table(std::string_view text, const std::string& path,
                                       const std::vector<std::string>& header) {
    std::vector<CsvRecord> records = parse_csv(text, path);
    if (records.empty() || records.front().fields != header) {
        std::string expected;
        append_csv_line(expected, header);
        expected.pop_back();
        throw InputError::at_line(path, 1, "expected the header line " + expected);
    }
    records.erase(records.begin());
    for (const CsvRecord& record : records) {
        if (record.fields.size() != header.size())
            throw InputError::at_line(path, record.line,
                                      "expected " + std::to_string(header.size()) +
                                          " fields, found " + std::to_string(record.fields.size()));
    }
    return records;
}

int64_t whole_number_field(const CsvRecord& record, size_t field, std::string_view what,
                           const std::string& path) {
    const std::string& text = record.fields[field];
    int64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || number < 0)
        throw InputError::at_line(
            path, record.line,
            "expected " + std::string(what) + ", found " + quote_for_message(text));
    return number;
}

}  // namespace kinetome
