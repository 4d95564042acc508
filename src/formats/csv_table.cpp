#include "kinetome/formats/csv_table.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "kinetome/base/error.h"
#include "kinetome/base/quote.h"

namespace kinetome {

namespace {

[[noreturn]] void refuse_header(const std::string& path, const std::vector<std::string>& header,
                                const char* how) {
    std::string expected;
    append_csv_line(expected, header);
    expected.pop_back();
    throw InputError::at_line(path, 1, how + expected);
}

/// Spreadsheets put one before the header, where no one sees it.
std::string_view without_byte_order_mark(std::string_view text) {
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    if (text.starts_with(mark)) text.remove_prefix(mark.size());
    return text;
}

/// Those below the header line.
std::vector<CsvRecord> records_like_the_header(std::vector<CsvRecord> records,
                                               const std::string& path) {
    const size_t columns = records.front().fields.size();
    records.erase(records.begin());
    for (const CsvRecord& record : records) {
        if (record.fields.size() != columns)
            throw InputError::at_line(path, record.line,
                                      "expected " + std::to_string(columns) + " fields, found " +
                                          std::to_string(record.fields.size()));
    }
    return records;
}

}  // namespace

std::vector<CsvRecord> parse_csv_table(std::string_view text, const std::string& path,
                                       const std::vector<std::string>& header) {
    std::vector<CsvRecord> records = parse_csv(without_byte_order_mark(text), path);
    if (records.empty() || records.front().fields != header) {
        refuse_header(path, header, "expected the header line ");
    }
    return records_like_the_header(std::move(records), path);
}

std::vector<CsvRecord> parse_csv_columns(std::string_view text, const std::string& path,
                                         const std::vector<std::string>& header) {
    std::vector<CsvRecord> records = parse_csv(without_byte_order_mark(text), path);
    const auto begins = [&](const std::vector<std::string>& columns) {
        return columns.size() >= header.size() &&
               std::equal(header.begin(), header.end(), columns.begin());
    };
    if (records.empty() || !begins(records.front().fields)) {
        refuse_header(path, header, "expected a header line that begins with ");
    }
    return records_like_the_header(std::move(records), path);
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
