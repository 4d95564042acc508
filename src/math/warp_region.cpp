#include "warp_region.h"

#include <algorithm>

namespace kinetome {
namespace {

RowRange hull(const RowRange& a, const RowRange& b) {
    if (a.size() <= 0) return b;
    if (b.size() <= 0) return a;
    return {std::min(a.first, b.first), std::max(a.end, b.end)};
}

/// The columns that paths from the beginning come to.
std::vector<RowRange> reached(int64_t n, int64_t m, std::span<const WarpStep> steps,
                              int64_t end_slip) {
    std::vector<RowRange> rows(static_cast<size_t>(n));
    const bool stands_still =
        std::ranges::any_of(steps, [](const WarpStep& step) { return step.first == 0; });
    for (int64_t i = 0; i < n; ++i) {
        RowRange columns;
        if (i == 0) columns = {0, std::min(end_slip + 1, m)};
        if (0 < i && i <= end_slip) columns = {0, 1};
        for (const WarpStep& step : steps) {
            if (step.first == 0 || step.first > i) continue;
            const RowRange& from = rows[static_cast<size_t>(i - step.first)];
            if (from.size() <= 0) continue;
            columns = hull(columns, {from.first + step.second, from.end + step.second});
        }
        if (columns.size() > 0 && stands_still) columns.end = m;
        columns.end = std::min(columns.end, m);
        rows[static_cast<size_t>(i)] = columns;
    }
    return rows;
}

}  // namespace

std::vector<RowRange> warp_region(int64_t n, int64_t m, std::span<const WarpStep> steps,
                                  int64_t end_slip) {
    // Steps are the same seen from the end, so the way back is the way there turned round.
    const std::vector<RowRange> there = reached(n, m, steps, end_slip);
    std::vector<RowRange> region(there);
    for (int64_t i = 0; i < n; ++i) {
        RowRange& columns = region[static_cast<size_t>(i)];
        const RowRange& back = there[static_cast<size_t>(n - 1 - i)];
        columns.first = std::max(columns.first, m - back.end);
        columns.end = std::min(columns.end, m - back.first);
        if (columns.size() <= 0 || back.size() <= 0) columns = {};
    }
    return region;
}

}  // namespace kinetome
