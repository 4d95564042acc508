#include "kinetome/formats/annotation.h"

#include "kinetome/base/error.h"
#include "kinetome/formats/csv_table.h"

namespace kinetome {
namespace {

const std::vector<std::string> cycle_header = {"clip", "first", "end", "label"};
const std::vector<std::string> truth_header = {"clip", "first", "end", "label", "end_lo", "end_hi"};

int64_t frame_field(const CsvRecord& record, size_t field, const std::string& path) {
    return whole_number_field(record, field, "a frame number", path);
}

void require_frames(int64_t first, int64_t end, const CsvRecord& record, const std::string& path) {
    if (first < end) return;
    throw InputError::at_line(path, record.line,
                              "expected an end after frame " + std::to_string(first) + ", found " +
                                  std::to_string(end) + " (it is the frame after the last)");
}

CycleRow cycle_row(const CsvRecord& record, const std::string& path) {
    const CycleRow row{.clip = from_csv_text(record.fields[0]),
                       .first = frame_field(record, 1, path),
                       .end = frame_field(record, 2, path),
                       .label = from_csv_text(record.fields[3]),
                       .line = record.line};
    require_frames(row.first, row.end, record, path);
    return row;
}

}  // namespace

void Annotations::append(const Annotations& other) {
    truth.insert(truth.end(), other.truth.begin(), other.truth.end());
    cycles.insert(cycles.end(), other.cycles.begin(), other.cycles.end());
}

std::string write_truth_csv(const std::vector<TruthRow>& rows) {
    std::string text;
    append_csv_line(text, truth_header);
    for (const TruthRow& row : rows)
        append_csv_line(
            text, {csv_text(row.clip), std::to_string(row.first), std::to_string(row.end),
                   csv_text(row.label), std::to_string(row.end_lo), std::to_string(row.end_hi)});
    return text;
}

std::string write_cycles_csv(const std::vector<CycleRow>& rows) {
    std::string text;
    append_csv_line(text, cycle_header);
    for (const CycleRow& row : rows)
        append_csv_line(text, {csv_text(row.clip), std::to_string(row.first),
                               std::to_string(row.end), csv_text(row.label)});
    return text;
}

std::vector<TruthRow> parse_truth_csv(std::string_view text, const std::string& path) {
    std::vector<TruthRow> rows;
    for (const CsvRecord& record : parse_csv_table(text, path, truth_header)) {
        const TruthRow& row = rows.emplace_back(TruthRow{.clip = from_csv_text(record.fields[0]),
                                                         .first = frame_field(record, 1, path),
                                                         .end = frame_field(record, 2, path),
                                                         .label = from_csv_text(record.fields[3]),
                                                         .end_lo = frame_field(record, 4, path),
                                                         .end_hi = frame_field(record, 5, path),
                                                         .line = record.line});
        require_frames(row.first, row.end, record, path);
        if (row.label.empty())
            throw InputError::at_line(path, record.line, "expected a label, found none");
    }
    return rows;
}

std::vector<CycleRow> parse_cycles_csv(std::string_view text, const std::string& path) {
    std::vector<CycleRow> rows;
    for (const CsvRecord& record : parse_csv_table(text, path, cycle_header))
        rows.push_back(cycle_row(record, path));
    return rows;
}

std::vector<CycleRow> parse_labels_csv(std::string_view text, const std::string& path) {
    std::vector<CycleRow> rows;
    for (const CsvRecord& record : parse_csv_columns(text, path, cycle_header)) {
        if (!record.fields[3].empty()) rows.push_back(cycle_row(record, path));
    }
    return rows;
}

}  // namespace kinetome
