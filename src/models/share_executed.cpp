#include "share_executed.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "kinetome/math/quantiles.h"
#include "path_costs.h"

namespace kinetome {

double share_executed(const FrameDistances& activity, std::span<const int64_t> starts,
                      int64_t side) {
    const int64_t last = activity.size() - 1, elapsed = last - starts.back();
    const MatrixF costs = path_costs(activity, {last, last + 1}, side);
    std::vector<double> shares;
    for (size_t s = 0; s + 1 < starts.size(); ++s) {
        const int64_t length = starts[s + 1] - starts[s], same_tempo = starts[s] + elapsed;
        const int64_t first = std::max(starts[s], same_tempo - length / 2);
        const int64_t end = std::min(starts.back(), same_tempo + length / 2 + 1);
        if (first >= end) continue;
        Eigen::Index nearest = 0;
        costs.row(0).segment(first, end - first).minCoeff(&nearest);
        shares.push_back(double(first + nearest + 1 - starts[s]) / double(length));
    }
    if (shares.empty()) return 1;  // it has lasted longer than any other
    return lower_quantile(std::move(shares), 0.5);
}

}  // namespace kinetome
