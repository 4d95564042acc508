// Known truth of a corpus: truth.csv (activities) and cycles.csv (repetitions).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinetome {

/// Frames [first, end) of a clip, counted from 0 at the source's rate.
struct CycleRow {
    std::string clip;
    int64_t first = 0, end = 0;
    std::string label;
    int64_t line = 0;  ///< of the file it was read from; 0: of none
};

/// The boundary at `end` is uncertain in [end_lo, end_hi): there the motion passes from one
/// activity to the next.
struct TruthRow {
    std::string clip;
    int64_t first = 0, end = 0;
    std::string label;
    int64_t end_lo = 0, end_hi = 0;
    int64_t line = 0;  ///< of the file it was read from; 0: of none
};

struct Annotations {
    std::vector<TruthRow> truth;
    std::vector<CycleRow> cycles;

    void append(const Annotations& other);
};

/// With header lines "clip,first,end,label,end_lo,end_hi" and "clip,first,end,label".
std::string write_truth_csv(const std::vector<TruthRow>& rows);
std::string write_cycles_csv(const std::vector<CycleRow>& rows);

/// Every row names its line. Throw InputError ("path:line: ...").
std::vector<TruthRow> parse_truth_csv(std::string_view text, const std::string& path);
std::vector<CycleRow> parse_cycles_csv(std::string_view text, const std::string& path);

/// Labelled frames of any table whose columns begin with clip,first,end,label: the two above, and
/// what `kinetome label` writes. Further columns are ignored, rows without a label left out.
std::vector<CycleRow> parse_labels_csv(std::string_view text, const std::string& path);

}  // namespace kinetome
