#include "kinetome/stages/work_share.h"

#include <algorithm>
#include <numeric>

namespace kinetome {

std::vector<int> share_out(const std::vector<int64_t>& amounts, int rank_count, bool together) {
    const int64_t whole = std::accumulate(amounts.begin(), amounts.end(), int64_t{0});
    std::vector<size_t> largest_first(amounts.size());
    std::iota(largest_first.begin(), largest_first.end(), size_t{0});
    std::stable_sort(largest_first.begin(), largest_first.end(),
                     [&](size_t a, size_t b) { return amounts[a] > amounts[b]; });

    std::vector<int> owners(amounts.size(), 0);
    std::vector<int64_t> to_do(static_cast<size_t>(rank_count));
    for (const size_t i : largest_first) {
        if (rank_count == 1) break;
        if (together && amounts[i] * rank_count > whole) {
            owners[i] = all_ranks;
            continue;
        }
        const auto idlest = std::min_element(to_do.begin(), to_do.end());
        owners[i] = static_cast<int>(idlest - to_do.begin());
        *idlest += amounts[i];
    }
    return owners;
}

}  // namespace kinetome
