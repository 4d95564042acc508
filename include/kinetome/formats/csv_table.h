// Comma-separated tables whose header line is part of a contract.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinetome/base/csv.h"

namespace kinetome {

/// The records below the header line, each with as many fields as it. Throws InputError
/// ("path:line: ...") when the header or a record is another.
std::vector<CsvRecord> parse_csv_table(std::string_view text, const std::string& path,
                                       const std::vector<std::string>& header);

/// The same of a table that may have more columns behind those of the header.
std::vector<CsvRecord> parse_csv_columns(std::string_view text, const std::string& path,
                                         const std::vector<std::string>& header);

/// The field as a whole number from 0; `what` names it where it is none. Throws InputError.
int64_t whole_number_field(const CsvRecord& record, size_t field, std::string_view what,
                           const std::string& path);

}  // namespace kinetome
