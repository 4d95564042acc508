#include "kinetome/stages/rank_schedule.h"

#include <algorithm>

#include "kinetome/stages/work_share.h"

namespace kinetome {
namespace {

/// Sums reach rank 0 over a network of this speed: ten gigabit Ethernet, the slowest that clusters
/// have.
constexpr double exchanged_bytes_per_second = 1e9;

constexpr double least_gain = 0.1;

double item_seconds(const LoadItem& item, double serial_share, int64_t workers) {
    const int64_t rounds = (item.pieces + workers - 1) / workers;
    const double parallel = static_cast<double>(rounds) / static_cast<double>(item.pieces);
    return item.fixed_seconds + item.seconds * (serial_share + (1 - serial_share) * parallel);
}

double exchange_seconds(const LoadItem& item, int ranks) {
    return ranks > 1 ? item.exchanged_bytes * ranks / exchanged_bytes_per_second : 0;
}

bool gains(double before, double after) {
    return before - after >= least_gain * before && before > 0;
}

}  // namespace

double load_seconds(const StageLoad& load, int threads, int ranks) {
    std::vector<int64_t> amounts;
    for (const LoadItem& item : load.items) amounts.push_back(item.amount);
    const std::vector<int> owners = share_out(amounts, ranks, load.shares_items);
    double together = 0;
    std::vector<double> alone(static_cast<size_t>(ranks), 0.0);
    for (size_t i = 0; i < owners.size(); ++i) {
        const LoadItem& item = load.items[i];
        if (owners[i] == all_ranks) {
            together += item_seconds(item, load.serial_share, int64_t{threads} * ranks) +
                        exchange_seconds(item, ranks);
        } else {
            alone[static_cast<size_t>(owners[i])] += item_seconds(item, load.serial_share, threads);
        }
    }
    return together + *std::max_element(alone.begin(), alone.end());
}

std::vector<RankSeconds> tabulate_ranks(const std::function<double(int ranks)>& seconds,
                                        int most_ranks) {
    std::vector<RankSeconds> table{{1, seconds(1)}};
    for (int ranks = 2; ranks <= most_ranks; ranks *= 2) {
        const double before = table.back().seconds;
        table.push_back({ranks, seconds(ranks)});
        if (!gains(before, table.back().seconds)) break;
    }
    return table;
}

int ranks_that_help(const std::vector<RankSeconds>& table) {
    int helpful = 1;
    for (size_t i = 1; i < table.size(); ++i) {
        if (!gains(table[i - 1].seconds, table[i].seconds)) break;
        helpful = table[i].ranks;
    }
    return helpful;
}

}  // namespace kinetome
